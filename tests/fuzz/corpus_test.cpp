#include "tests/fuzz/fuzz_folder.h"
#include "tests/sim/scene/loads_or_rejects.h"

#include <gtest/gtest.h>

namespace {

TEST(FuzzCorpus, IsReadOrRefusedInOneLine)
{
    const test::FuzzFolder folder;
    int scenes = 0, all = 0;
    for (const auto& entry : std::filesystem::directory_iterator(FUZZ_CORPUS_DIR)) {
        SCOPED_TRACE(entry.path().string());
        ++all;
        try {
            scenes += test::loadsOrComplains(app::test::contentOf(entry.path()), folder.name(), folder.options());
        } catch (const std::exception& error) {
            ADD_FAILURE() << error.what();
        }
    }
    EXPECT_GT(scenes, 20) << "too few of them are scenes to reach what comes after the syntax";
    EXPECT_GT(all, scenes);
}

}  // namespace
