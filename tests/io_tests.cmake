# Tests of the room in this file's name.
raypick_test(scene_test LABELS cpu)
raypick_test(scene_file_test LABELS cpu)
raypick_test(obj_test LABELS cpu)
raypick_test(ply_test LABELS cpu)
raypick_test(stl_test LABELS cpu)
raypick_test(normals_test LABELS cpu)
raypick_test(gltf_test LABELS cpu)
raypick_test(load_models_test LABELS data)
