# Tests of the room in this file's name.
raypick_test(transform_test LABELS cpu)
raypick_test(camera_test LABELS cpu)
raypick_test(shapes_test LABELS cpu)
raypick_test(accel_test LABELS cpu)
raypick_test(accel_threads_test LABELS cpu threads)
raypick_test(accel_models_test LABELS data)
raypick_test(surface_test LABELS cpu)
raypick_test(trace_test LABELS cpu)
raypick_test(render_job_test LABELS cpu threads)

# Written images are read back.
find_package(OpenEXR REQUIRED)
pkg_check_modules(stb REQUIRED IMPORTED_TARGET stb)
raypick_test(image_test LABELS cpu LIBS OpenEXR::OpenEXR PkgConfig::stb)
