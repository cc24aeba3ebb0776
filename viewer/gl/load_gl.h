// The OpenGL 3.3 core functions of the current context.
#pragma once

#include <glad/gl.h>

#include <string>

namespace raypick {

// Fills the process-wide function table from the context that is current on this thread; call it
// again whenever another context is made. Throws Error if the context is older than OpenGL 3.3.
void load_gl(GLADloadfunc get_proc_address);

// GL_RENDERER and GL_VERSION of the current context, for messages.
std::string gl_description();

// True if the current context's OpenGL draws with the CPU.
bool draws_in_software();

// Largest number of elements of a buffer texture in the current context.
std::size_t max_buffer_texels();

// Turns pending OpenGL errors into an Error that says what was being done.
void check_gl(const std::string& doing);

}  // namespace raypick
