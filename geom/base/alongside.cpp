#include "geom/base/alongside.h"

#include <sys/resource.h>
#include <unistd.h>

namespace sterna::detail {

void yield_to_others() {
  constexpr int k_nice = 10;  // about a tenth of the weight of a thread of normal priority
  // On Linux the nice value belongs to the thread, and may always be raised.
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), k_nice);
}

}  // namespace sterna::detail
