#pragma once

#include <functional>
#include <string>

namespace shadowbench::options {

/// Receives how far a run is; the command line shows it.
class Progress {
 public:
  virtual ~Progress() = default;
  /// A run of `cells` cells begins, of which `finished` were finished before.
  virtual void begin(int cells, int finished) = 0;
  /// What is named is under way, `done` cells are finished.
  virtual void show(int done, const std::string& what) = 0;
  /// The user should know this; it is shown once.
  virtual void note(const std::string& message) = 0;
};

/// Hears what is under way.
using StepListener = std::function<void(const std::string& what)>;

}  // namespace shadowbench::options
