// So must it with this one, in a room that is on no floor.
#include "app/system/clock.h"
