#pragma once

// All GL objects. They are move-only, labelled, made by direct state access, and die with their scope, which must lie
// inside the life of their context. Ids are for harness/gl and harness/render; they cross no other folder's signatures.
#include "harness/gl/buffer.h"
#include "harness/gl/framebuffer.h"
#include "harness/gl/query.h"
#include "harness/gl/sampler.h"
#include "harness/gl/texture.h"
#include "harness/gl/vertex_array.h"
