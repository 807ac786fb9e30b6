// Reference to an object of the caller, for classes that keep it.
#pragma once

#include <type_traits>

namespace sterna {

/// Parameter of a constructor or function whose result refers to the object: the caller has to keep the object for as long as it uses the result. A temporary,
/// which would end before, does not convert to this type.
template <class T>
class Borrowed {
 public:
  constexpr Borrowed(T& object) : object_(&object) {}
  Borrowed(const std::remove_const_t<T>&&) = delete;

  constexpr operator T&() const { return *object_; }
  constexpr T& get() const { return *object_; }
  constexpr T* operator->() const { return object_; }

 private:
  T* object_;
};

}  // namespace sterna
