# Tests of the room in this file's name.
raypick_test(input_test LABELS cpu LIBS raypick_app_logic)
raypick_test(orbit_test LABELS cpu LIBS raypick_app_logic)
raypick_test(scene_view_gl_test LABELS gl LIBS raypick_app_logic)
if(TARGET raypick)
    raypick_test(command_test LABELS cpu SOURCES program.cpp)
    raypick_test(render_command_test LABELS cpu SOURCES program.cpp)
    raypick_test(save_command_test LABELS cpu SOURCES program.cpp)
    raypick_test(command_data_test LABELS data SOURCES program.cpp)
    raypick_test(command_gl_test LABELS gl SOURCES program.cpp)
    raypick_test(document_test LABELS cpu data LIBS raypick_app_logic SOURCES program.cpp)
    raypick_test(window_test LABELS window LIBS raypick_app_logic SOURCES desktop.cpp program.cpp
                 TIMEOUT 600)
    foreach(name IN ITEMS command_test render_command_test save_command_test command_data_test
            command_gl_test document_test window_test)
        target_compile_definitions(${name} PRIVATE RAYPICK_PROGRAM="$<TARGET_FILE:raypick>")
        add_dependencies(${name} raypick)
    endforeach()
endif()
