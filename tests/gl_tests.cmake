# Tests of the room in this file's name.
raypick_test(gl_handle_gl_test LABELS gl LIBS raypick_raster)
raypick_test(rasterizer_gl_test LABELS gl LIBS raypick_raster)
raypick_test(unseen_gl_test LABELS gl LIBS raypick_raster)
raypick_test(raster_light_gl_test LABELS gl LIBS raypick_raster)
raypick_test(raster_shapes_gl_test LABELS gl LIBS raypick_raster)
raypick_test(footprint_gl_test LABELS gl LIBS raypick_raster)
raypick_test(raster_texture_gl_test LABELS gl LIBS raypick_raster)

# These open model files.
if(TARGET raypick_io)
    raypick_test(agreement_gl_test LABELS gl data LIBS raypick_raster raypick_io TIMEOUT 600)
    raypick_test(raster_trace_gl_test LABELS gl data LIBS raypick_raster raypick_io TIMEOUT 600)
    raypick_test(gallery_gl_test LABELS gl LIBS raypick_raster raypick_io)
endif()
