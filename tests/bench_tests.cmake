# The benchmarks: `cmake --workflow --preset bench` runs all of them, CTest (label bench) each once
# and small, so that they never rot. Not under sanitizers, which would be all that they measure.
if(TARGET raypick_io AND NOT RAYPICK_SANITIZE)
    add_executable(raypick_bench
        bench/builds.cpp
        bench/command.cpp
        bench/embree_modes.cpp
        bench/embree_renderer.cpp
        bench/embree_scene.cpp
        bench/embree_shading.cpp
        bench/frame_peers.cpp
        bench/frames.cpp
        bench/instruction_sets.cpp
        bench/kernels.cpp
        bench/loads.cpp
        bench/machine.cpp
        bench/main.cpp
        bench/measure.cpp
        bench/memory.cpp
        bench/options.cpp
        bench/our_modes.cpp
        bench/picks.cpp
        bench/model_writers.cpp
        bench/ray_sets.cpp
        bench/reads.cpp
        bench/report.cpp
        bench/scenes.cpp
        bench/screen.cpp
        bench/tachyon_scene.cpp
        pov_scene.cpp)
    raypick_join_sources(raypick_bench 8)
    find_package(nlohmann_json REQUIRED)
    target_link_libraries(raypick_bench PRIVATE raypick_tracer raypick_io raypick_picking
                          raypick_flags fmt::fmt nlohmann_json::nlohmann_json)
    target_include_directories(raypick_bench PRIVATE ${PROJECT_SOURCE_DIR})
    set(program "")
    if(TARGET raypick)
        set(program $<TARGET_FILE:raypick>)
    endif()
    set(bench_folder ${PROJECT_BINARY_DIR}/bench)
    target_compile_definitions(raypick_bench PRIVATE
        RAYPICK_MODELS="${RAYPICK_MODELS}" RAYPICK_PROGRAM="${program}"
        RAYPICK_BENCH_FOLDER="${bench_folder}")
    find_package(embree 3 QUIET)
    if(embree_FOUND)
        target_link_libraries(raypick_bench PRIVATE embree)
        target_compile_definitions(raypick_bench PRIVATE RAYPICK_HAS_EMBREE)
    endif()

    find_package(assimp QUIET)
    if(assimp_FOUND)
        target_link_libraries(raypick_bench PRIVATE assimp::assimp)
        target_compile_definitions(raypick_bench PRIVATE RAYPICK_HAS_ASSIMP)
    endif()
    find_package(tinyobjloader QUIET)
    if(tinyobjloader_FOUND)
        target_link_libraries(raypick_bench PRIVATE tinyobjloader::tinyobjloader)
        target_compile_definitions(raypick_bench PRIVATE RAYPICK_HAS_TINYOBJ)
    endif()

    file(MAKE_DIRECTORY ${bench_folder})
    add_custom_target(bench COMMAND raypick_bench --json=bench.json
                      WORKING_DIRECTORY ${bench_folder} USES_TERMINAL VERBATIM)
    if(TARGET raypick)
        add_dependencies(bench raypick)
    endif()
    add_test(NAME raypick_bench.smoke COMMAND raypick_bench --smoke --json=smoke.json
             WORKING_DIRECTORY ${bench_folder})
    set_tests_properties(raypick_bench.smoke PROPERTIES LABELS bench TIMEOUT 120)
endif()
