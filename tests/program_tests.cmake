# Tests of the room in this file's name.
raypick_test(input_test LABELS cpu LIBS raypick_app_logic)
raypick_test(orbit_test LABELS cpu LIBS raypick_app_logic)
raypick_test(scene_view_gl_test LABELS gl LIBS raypick_app_logic)
if(TARGET raypick)
    add_library(program_under_test OBJECT program.cpp)
    target_link_libraries(program_under_test PRIVATE raypick_flags)
    target_compile_definitions(program_under_test PRIVATE
        RAYPICK_PROGRAM="$<TARGET_FILE:raypick>")
    add_dependencies(program_under_test raypick)

    raypick_test(command_test LABELS cpu LIBS program_under_test)
    raypick_test(render_command_test LABELS cpu LIBS program_under_test)
    raypick_test(save_command_test LABELS cpu LIBS program_under_test)
    raypick_test(command_data_test LABELS data LIBS program_under_test)
    raypick_test(command_gl_test LABELS gl LIBS program_under_test)
    raypick_test(document_test LABELS cpu data LIBS raypick_app_logic program_under_test)
    raypick_test(window_test LABELS window LIBS raypick_app_logic program_under_test
                 SOURCES desktop.cpp TIMEOUT 600)
endif()
