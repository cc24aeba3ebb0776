# Tests of the room in this file's name.
raypick_test(scene_test LABELS cpu)
raypick_test(scene_file_test LABELS cpu)
raypick_test(obj_test LABELS cpu)
