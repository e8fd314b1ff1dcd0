#include "app/program.h"
#include "tests/app/fake_backends.h"

int main(int argc, char** argv) { return app::runProgram(argc, argv, app::test::toyBackendsFromFiles()); }
