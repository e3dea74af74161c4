#pragma once

// The one place that includes the generated loader. It must come before any other GL header: glad then claims their
// include guards, and <GL/osmesa.h>, <GLFW/glfw3.h> and <EGL/egl.h> do not bring a second set of declarations.
#include <glad/gl.h>
