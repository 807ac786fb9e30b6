// A virtual file driver through which libhdf5 writes to an AtomicFile. Only for hdf5_output.cpp, which includes hdf5.h.
#pragma once

#include <cstdint>
#include <exception>

#include "geom/base/borrowed.h"
#include "io/output/atomic_file.h"

namespace sterna::io {

/// Passes the library's output to the file. After a failure the error is stored and further output is discarded: libhdf5 crashes at program exit if it cannot
/// write the data needed to close a file, for example on a full disk.
class Hdf5Driver {
 public:
  /// \pre the driver outlives the library's file
  explicit Hdf5Driver(Borrowed<AtomicFile> file);
  ~Hdf5Driver();
  Hdf5Driver(const Hdf5Driver&) = delete;
  Hdf5Driver& operator=(const Hdf5Driver&) = delete;

  /// Selects this driver for files created with the access list. Returns false if the library refuses.
  bool set_on(std::int64_t access);
  /// Throws the stored AtomicFile error, if any.
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

  /// Calls f on the file and stores any exception. For the driver's functions.
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
