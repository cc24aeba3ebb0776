# Tests of the room in this file's name.
raypick_test(click_detector_test LABELS cpu)
raypick_test(cursor_test LABELS cpu)
raypick_test(pick_test LABELS cpu)
raypick_test(selection_test LABELS cpu)
