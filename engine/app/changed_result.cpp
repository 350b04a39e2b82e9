#include "engine/app/changed_result.h"

#include <cstdio>

namespace poesy::app {

StoredResult read_result_warily(const std::string& path) {
  StoredResult result = read_result(path);
  if (result.changed) {
    const std::string text = "poesy: warning: " + path + " was changed since it was written; see poesy verify\n";
    std::fputs(text.c_str(), stderr);
  }
  return result;
}

}  // namespace poesy::app
