// What a verb hands to the stages that it runs.
#pragma once

#include <string>
#include <vector>

namespace sterna::scripting {

class StageCache;  // stage_cache.h

struct Reuse {
  const StageCache* cache = nullptr;          ///< null: everything is made anew
  std::vector<std::string>* lines = nullptr;  ///< gets a line for each stage that came from the cache
};

}  // namespace sterna::scripting
