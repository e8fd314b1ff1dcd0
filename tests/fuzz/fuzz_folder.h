#pragma once

#include "sim/scene/scene_file.h"
#include "tests/app/temporary_folder.h"

#include <string>

namespace test {

/// Where texts from anywhere are read as scenes: a folder with one file to include and out of which nothing is read, and
/// bounds that keep a scene quick to read.
class FuzzFolder {
 public:
    FuzzFolder()
    {
        app::test::writeFile(folder_ / "part.yaml", "time: {dt: 1.0e-3}\ngrid: {cell: 0.2}\n");
        options_.bounds = {.folder = folder_.path(), .values = 5000, .vertices = 300, .maxBoxes = 64};
    }
    std::string name() const { return (folder_ / "fuzz.yaml").string(); }
    const sim::LoadOptions& options() const { return options_; }

 private:
    app::test::TemporaryFolder folder_;
    sim::LoadOptions options_;
};

}  // namespace test
