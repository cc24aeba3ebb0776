# Tests of the room in this file's name.
raypick_test(scene_test LABELS cpu)
raypick_test(transform_test LABELS cpu)
raypick_test(camera_test LABELS cpu)
raypick_test(shapes_test LABELS cpu)
raypick_test(accel_test LABELS cpu)
raypick_test(accel_threads_test LABELS cpu threads)
raypick_test(accel_models_test LABELS data)
