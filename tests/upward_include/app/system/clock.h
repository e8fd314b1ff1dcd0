// A file that tests/check_includes must find fault with.
#include "app/runs/resume.h"
