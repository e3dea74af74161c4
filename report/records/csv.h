#pragma once

#include <string>
#include <string_view>

namespace shadowbench::records {

/// Quotes a text as one CSV field, where it needs quoting. A text that a spreadsheet would run as a formula gets an
/// apostrophe in front; numbers stay as they are.
/// Source: RFC 4180.
std::string quote_csv(std::string_view text);

}  // namespace shadowbench::records
