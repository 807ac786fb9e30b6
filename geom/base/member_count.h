// Number of members of a plain struct, counted by the compiler, so that no list has to state it.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <variant>

namespace sterna {
namespace detail {

/// Converts to any type. Types with a converting constructor template of their own need a kind of their own, because both conversions would be ambiguous.
struct AnyMember {
  template <class U>
  operator U() const;  // never defined
};
struct OptionalMember {
  template <class U>
  operator std::optional<U>() const;
};
struct VariantMember {
  template <class... U>
  operator std::variant<U...>() const;
};
struct FunctionMember {
  template <class U>
  operator std::function<U>() const;
};

template <class T, class... Members>
concept InitialisedBy = requires {
  T{Members{}...};
};

template <class T, class... Members>
constexpr std::size_t count_members() {
  if constexpr (InitialisedBy<T, Members..., AnyMember>) return count_members<T, Members..., AnyMember>();
  else if constexpr (InitialisedBy<T, Members..., OptionalMember>) return count_members<T, Members..., OptionalMember>();
  else if constexpr (InitialisedBy<T, Members..., VariantMember>) return count_members<T, Members..., VariantMember>();
  else if constexpr (InitialisedBy<T, Members..., FunctionMember>) return count_members<T, Members..., FunctionMember>();
  else return sizeof...(Members);
}

}  // namespace detail

/// Returns the number of members of an aggregate without base classes and without C arrays.
template <class T>
constexpr std::size_t member_count() {
  return detail::count_members<T>();
}

}  // namespace sterna
