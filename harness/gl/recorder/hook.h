#pragma once

#include <type_traits>
#include <utility>

namespace shadowbench::gl {

/// Puts itself in place of a function without a result that the loader points to: calls it, and then `kThen` with the
/// same arguments.
template <auto* kSlot, auto kThen, class Function = std::remove_pointer_t<decltype(kSlot)>>
class Hook;

template <auto* kSlot, auto kThen, class... Arguments>
class Hook<kSlot, kThen, void (*)(Arguments...)> {
 public:
  /// Puts it in place, or takes it away: not where the loader has another function since, of another context.
  static void set(bool is_on) {
    if (is_on)
      original_ = std::exchange(*kSlot, call);
    else if (*kSlot == call)
      *kSlot = original_;
  }

 private:
  static inline void (*original_)(Arguments...) = nullptr;

  static void call(Arguments... arguments) {
    original_(arguments...);
    kThen(arguments...);
  }
};

}  // namespace shadowbench::gl
