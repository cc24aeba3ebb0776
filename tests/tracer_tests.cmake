# Tests of the room in this file's name.
raypick_test(transform_test LABELS cpu)
raypick_test(camera_test LABELS cpu)
raypick_test(shapes_test LABELS cpu)
raypick_test(curved_shapes_test LABELS cpu)
raypick_test(accel_test LABELS cpu)
raypick_test(sets_test LABELS cpu)
raypick_test(no_acne_test LABELS cpu)
raypick_test(accel_threads_test LABELS cpu threads)
raypick_test(surface_test LABELS cpu)
raypick_test(trace_test LABELS cpu)
raypick_test(check_scene_test LABELS cpu)
raypick_test(render_job_test LABELS cpu threads)
raypick_test(sampling_test LABELS cpu threads)
raypick_test(lens_test LABELS cpu)

# Written images are read back.
find_package(OpenEXR REQUIRED)
pkg_check_modules(stb REQUIRED IMPORTED_TARGET stb)
raypick_test(image_test LABELS cpu LIBS OpenEXR::OpenEXR PkgConfig::stb)

# These open model files.
if(TARGET raypick_io)
    raypick_test(accel_models_test LABELS data)
    raypick_test(spd_oracle_test LABELS oracle data SOURCES spd_scenes.cpp TIMEOUT 600)
    raypick_test(povray_oracle_test LABELS oracle SOURCES pov_scene.cpp TIMEOUT 600)
    # Without Embree the test says so: skipped at home, failed in CI.
    raypick_test(embree_oracle_test LABELS oracle TIMEOUT 600)
    find_package(embree 3 QUIET)
    if(embree_FOUND)
        target_link_libraries(embree_oracle_test PRIVATE embree)
        target_compile_definitions(embree_oracle_test PRIVATE RAYPICK_HAS_EMBREE)
    endif()
endif()
