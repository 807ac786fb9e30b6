// How libhdf5 reaches an AtomicFile: a virtual file driver. For hdf5_output.cpp alone, which includes hdf5.h.
#pragma once

#include <cstdint>
#include <exception>

#include "io/output/atomic_file.h"

namespace sterna::io {

/// What the library writes goes to the file until that fails; then the failure is kept and the rest goes nowhere, because the library crashes at the end of the
/// program where it cannot write what it needs to close a file, be it on a full disk.
class Hdf5Driver {
 public:
  /// \pre `file` outlives the driver, which outlives the library's file
  explicit Hdf5Driver(AtomicFile& file);
  ~Hdf5Driver();
  Hdf5Driver(const Hdf5Driver&) = delete;
  Hdf5Driver& operator=(const Hdf5Driver&) = delete;

  /// Makes the library use it for files that are created with this access list. False: the library refuses.
  bool set_on(std::int64_t access);
  /// Throws what AtomicFile threw in a call of the library, if it did.
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

  /// For the driver's functions: calls f on the file, keeps what it throws.
  template <class F>
  void attempt(const F& f) noexcept {
    if (failure_) return;
    try {
      f(file_);
    } catch (...) {
      failure_ = std::current_exception();
    }
  }
  bool has_failed() const { return failure_ != nullptr; }

 private:
  AtomicFile& file_;
  std::exception_ptr failure_;
  std::int64_t id_ = -1;  ///< a hid_t
};

}  // namespace sterna::io
