#pragma once

#include "report/page/blocks.h"
#include "report/regress/regress.h"

namespace shadowbench::regress {

/// Makes the page of `shadowbench regress`: what differs, the worst first, with its pictures, and how to accept it.
page::Page make_regress_page(const RegressReport& report);

}  // namespace shadowbench::regress
