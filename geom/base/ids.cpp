#include "geom/base/ids.h"

#include <string>

#include "geom/base/error.h"

namespace sterna {

void throw_id_overflow(std::uint64_t value) {
  throw Error({.code = ErrorCode::overflow,
               .attempted = "numbering mesh entities",
               .problem = "index " + std::to_string(value) + " does not fit into 32 bits (limit 4294967294)",
               .hint = "split the case into smaller meshes"});
}

}  // namespace sterna
