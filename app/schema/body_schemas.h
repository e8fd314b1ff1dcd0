#pragma once

#include "app/schema/key_schema.h"

namespace app {

// What stands in lists and within others: shapes, sources, obstacles, fabric, pins, motions. All are definitions of the scene's schema.

SchemaJson bodyDefinitions();

}  // namespace app
