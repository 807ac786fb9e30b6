// A measured time or amount of memory.
#pragma once

namespace sterna {

/// A measurement of this run, used like the number. It is not part of the result, so keys and stored results leave it out.
class Measured {
 public:
  constexpr Measured(double value = 0.0) : value_(value) {}
  constexpr operator double() const { return value_; }
  constexpr Measured& operator+=(double more) {
    value_ += more;
    return *this;
  }

 private:
  double value_;
};

}  // namespace sterna
