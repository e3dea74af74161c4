#pragma once

#include <concepts>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

namespace shadowbench::records {

// One description of every record that is read again: writing, reading, `absent`, the schema and the CSV columns follow
// from it. `visit_fields(record, visit)` calls `visit(path, value, about)` for each field, or without the last where
// there is nothing to say; a dot in the path is a group.

/// What a description says of a field beside its name and type.
struct About {
  std::string_view text = {};                  ///< what the schema says of it
  std::optional<double> least = std::nullopt;  ///< of a number, or of the length of a list; counts are never negative
  std::optional<double> most = std::nullopt;   ///< of a number
  std::string_view pattern = {};               ///< that a text matches
  std::string_view one_of = {};                ///< texts that it may be, with commas
  bool filled = false;    ///< a text, or each of a list, is not empty; what may be null is filled where it is not
  bool is_path = false;   ///< in the report's folder, and does not leave it
  bool may_lack = false;  ///< what is not there is not written, and is no gap that needs a reason
  std::string_view column = {};       ///< what its column in CSV holds; empty: it has none
  std::string_view column_name = {};  ///< empty: it follows from the path
  std::string_view unit = {};         ///< of a metric; empty: it is none
};

/// What is visited instead of a value where a description speaks of a group.
struct Group {};
inline constexpr Group kGroup;

/// A record of this type, constant or not.
template <class Given, class Record>
concept Is = std::same_as<std::remove_const_t<Given>, Record>;

/// A text that is null in JSON where it is empty.
inline std::optional<std::string> null_if_empty(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional(text);
}

/// Visits the fields of a record as a group: they are fields of the record that it is in.
void visit_group(const std::string& name, auto& record, auto&& visit, const About& about = {}) {
  visit(name, kGroup, about);
  visit_fields(record, [&](const std::string& member, auto& value, const About& field = {}) {
    visit(name + "." + member, value, field);
  });
}

}  // namespace shadowbench::records
