#pragma once

#include <toml++/toml.h>

#include <string>

namespace shadowbench::scene {

/// Writes a document for people: numbers with as few digits as are read back as the same, the values of a table before
/// the tables in it, a list on one line. Requires keys that need no quotes.
std::string write_toml(const toml::table& document);

}  // namespace shadowbench::scene
