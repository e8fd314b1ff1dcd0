#include "app/program.h"
#include "tests/app/fake_parts.h"

int main(int argc, char** argv) { return app::runProgram(argc, argv, app::test::toyPartsFromFiles()); }
