// And inside sim/: particles do not know where they come from.
#include "sim/sources/emit.h"
