#pragma once

#include <type_traits>
#include <utility>

namespace shadowbench::gl {

/// Puts itself in place of a function that the loader points to: calls it, and then `kThen` with the same arguments.
template <auto* kSlot, auto kThen, class Function = std::remove_pointer_t<decltype(kSlot)>>
class Hook;

template <auto* kSlot, auto kThen, class Result, class... Arguments>
class Hook<kSlot, kThen, Result (*)(Arguments...)> {
 public:
  static void install() { original_ = std::exchange(*kSlot, call); }
  static void remove() {
    if (*kSlot == call) *kSlot = original_;  // the loader has others since another context was made current
  }

 private:
  static inline Result (*original_)(Arguments...) = nullptr;

  static Result call(Arguments... arguments) {
    original_(arguments...);
    kThen(arguments...);
  }
};

}  // namespace shadowbench::gl
