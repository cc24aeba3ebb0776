# Tests of the room in this file's name.
raypick_test(input_test LABELS cpu LIBS raypick_app_logic)
raypick_test(orbit_test LABELS cpu LIBS raypick_app_logic)
