#pragma once

#include "filters/base/atomic_file.h"

namespace shadowbench::files {

using shadowbench::AtomicFile;
using shadowbench::PendingFile;
using shadowbench::write_text_file;

}  // namespace shadowbench::files
