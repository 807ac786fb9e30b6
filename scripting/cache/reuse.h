// What a verb hands to the stages that it runs.
#pragma once

#include <string>
#include <vector>

namespace sterna::scripting {

class StageCache;    // stage_cache.h
class ReferenceUse;  // scripting/values/kept_reference.h

struct Reuse {
  const StageCache* cache = nullptr;          ///< null: everything is made anew
  std::vector<std::string>* lines = nullptr;  ///< gets a line for each stage that came from the cache, or started from a reference
  ReferenceUse* reference = nullptr;          ///< of the series whose case runs; null: there is none
};

}  // namespace sterna::scripting
