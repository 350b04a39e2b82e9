#pragma once

#include "engine/base/wording.h"  // IWYU pragma: export
