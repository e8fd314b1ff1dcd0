// For libFuzzer: any bytes are a scene or are refused in one line. tests/fuzz/run builds and starts it.

#include "tests/fuzz/fuzz_folder.h"
#include "tests/sim/scene/loads_or_rejects.h"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count);

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count)
{
    static const test::FuzzFolder folder;
    test::loadsOrComplains({bytes, bytes + count}, folder.name(), folder.options());
    return 0;
}
