// Programs that are built with a sanitizer take many times the time and memory: limits of either are not for them.
#pragma once

namespace sterna::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool k_is_sanitized = true;
#else
inline constexpr bool k_is_sanitized = false;
#endif

}  // namespace sterna::test
