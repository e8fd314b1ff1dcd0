#pragma once

#include "app/ensemble/vary.h"
#include "app/study/study.h"

#include <filesystem>
#include <functional>
#include <vector>

namespace app {

/// Runs of one scene that are to differ by chance alone, or by a setting that is known so well only.
struct EnsembleRequest {
    SceneRequest scene;
    std::vector<Vary> varied;
    int count = 20;
    int first = 0;                 ///< number of the first run: others are other draws
    std::filesystem::path folder;  ///< folder of the results
};

/// The study that does them; its file is ensemble.yaml in the folder, which is not written yet. Throws InputError for a scene that would be refused.
Study ensembleStudy(const EnsembleRequest& request, const std::function<LoadedScene(const SceneRequest&)>& load);

/// The text of that file: a study like any other.
std::string ensembleText(const Study& study, const EnsembleRequest& request);

}  // namespace app
