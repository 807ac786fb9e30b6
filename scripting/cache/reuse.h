// Data that a verb passes to the stages it runs.
#pragma once

#include <string>
#include <vector>

namespace sterna::scripting {

class StageCache;    // stage_cache.h
class ReferenceUse;  // scripting/values/kept_reference.h

struct Reuse {
  const StageCache* cache = nullptr;          ///< null: everything is recomputed
  std::vector<std::string>* lines = nullptr;  ///< receives a line for each stage that came from the cache, or started from a reference
  ReferenceUse* reference = nullptr;          ///< reference of the series of the running case; null: there is none
};

}  // namespace sterna::scripting
