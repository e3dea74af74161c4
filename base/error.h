#pragma once

#include <exception>
#include <string>
#include <utility>

namespace shadowbench {

/// What kind of thing failed; the values are the program's exit codes.
enum class ErrorKind {
  kLimit = 1,    ///< a limit or baseline was not met
  kUsage = 2,    ///< unknown names, values out of range, a size the GL cannot give
  kInput = 3,    ///< an input file is missing, malformed or not finite
  kContext = 4,  ///< no GL context
  kFilter = 5,   ///< a filter file: its GLSL or its front matter
  kOutput = 6,   ///< output could not be written
};

/// Carries bad input, a bad shader, device or output to the command line, which alone catches it.
class Error : public std::exception {
 public:
  /// `message` says what failed, with which value, and what to do; `where` is "file", "file:line" or empty.
  Error(ErrorKind kind, std::string message, std::string where = {})
      : kind_(kind), message_(std::move(message)), where_(std::move(where)) {
    what_ = where_.empty() ? message_ : where_ + ": " + message_;
  }

  ErrorKind kind() const { return kind_; }
  const std::string& message() const { return message_; }
  const std::string& where() const { return where_; }
  const char* what() const noexcept override { return what_.c_str(); }

 private:
  ErrorKind kind_;
  std::string message_;
  std::string where_;
  std::string what_;
};

/// Throws an Error of kind kInput.
[[noreturn]] inline void fail_input(std::string message, std::string where = {}) {
  throw Error(ErrorKind::kInput, std::move(message), std::move(where));
}

}  // namespace shadowbench
