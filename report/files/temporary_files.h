#pragma once

#include "filters/base/temporary_files.h"

namespace shadowbench::files {

using shadowbench::is_gone;
using shadowbench::is_temporary;
using shadowbench::make_temporary_folder_path;
using shadowbench::make_temporary_path;
using shadowbench::remove_temporary_files;

}  // namespace shadowbench::files
