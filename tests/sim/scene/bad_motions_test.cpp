#include "tests/sim/scene/bad_scene.h"

// Obstacles and motions.

namespace {

const BadScene kBadScenes[] = {
    {"ObstaclesIsMap", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
obstacles: {tank: 1}
)",
     "bad.yaml:3: obstacles: needs a list like [{shape: …}], not a map"},
    {"ObstacleInsideIsWord", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
obstacles: [{shape: {ball: {center: [9, 0, 0], radius: 1}}, inside: maybe}]
)",
     "bad.yaml:3: obstacles.0.inside: needs true or false, not \"maybe\""},
    {"MotionBackwards", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
obstacles:
  - name: paddle
    shape: {ball: {center: [9, 0, 0], radius: 1}}
    motion: {t: [1, 0], translate: [0, 1, 0]}
)",
     "bad.yaml:6: obstacles.paddle.motion.t: must end after it begins"},
    {"MotionEases", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
obstacles:
  - name: paddle
    shape: {ball: {center: [9, 0, 0], radius: 1}}
    motion: {t: [0, 1], ease: [0.6, 0.6], translate: [0, 1, 0]}
)",
     "bad.yaml:6: obstacles.paddle.motion.ease: both together must fit into t"},
    {"MotionOfNothing", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
obstacles:
  - name: paddle
    shape: {ball: {center: [9, 0, 0], radius: 1}}
    motion: {t: [0, 1]}
)",
     "bad.yaml:6: obstacles.paddle.motion: needs one of translate, rotate, oscillate, keys"},
    {"MotionOfBoth", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
obstacles:
  - name: paddle
    shape: {ball: {center: [9, 0, 0], radius: 1}}
    motion: {t: [0, 1], translate: [0, 1, 0], rotate: {angle: 90}}
)",
     "bad.yaml:6: obstacles.paddle.motion: needs one of translate, rotate, oscillate, keys"},
    {"MotionWithoutSpan", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
obstacles:
  - name: paddle
    shape: {ball: {center: [9, 0, 0], radius: 1}}
    motion: {translate: [0, 1, 0]}
)",
     "bad.yaml:6: obstacles.paddle.motion: t is missing; it is the span of time, like t: [0, 0.2]"},
    {"MotionKeysBackwards", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
obstacles:
  - name: paddle
    shape: {ball: {center: [9, 0, 0], radius: 1}}
    motion: {keys: [[0, 0, 0, 0], [1, 1, 0, 0], [1, 2, 0, 0]]}
)",
     "bad.yaml:6: obstacles.paddle.motion.keys: times must ascend"},
    {"MotionKeysShort", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
obstacles:
  - name: paddle
    shape: {ball: {center: [9, 0, 0], radius: 1}}
    motion: {keys: [[0, 0, 0, 0], [1, 1, 0]]}
)",
     "bad.yaml:6: obstacles.paddle.motion.keys: a row is [t, x, y, z], not a list of 3"},
    {"MotionAngleWithoutAmplitude", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
obstacles:
  - name: paddle
    shape: {ball: {center: [9, 0, 0], radius: 1}}
    motion: {t: [0, 1], oscillate: {frequency: 2}}
)",
     "bad.yaml:6: obstacles.paddle.motion.oscillate.amplitude is missing; it is how far it swings to each side, a length (with axis: an "
     "angle)"},
    {"MotionOfNobody", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
motion: [{obstacle: paddel, t: [0, 1], translate: [0, 1, 0]}]
)",
     "bad.yaml:3: motion: no obstacle, pin or fabric is named \"paddel\""},
    {"MotionNameless", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
motion: [{t: [0, 1], translate: [0, 1, 0]}]
)",
     "bad.yaml:3: motion: obstacle is missing; it is the name of what moves, like obstacle: paddle"},
};

class BadMotions : public testing::TestWithParam<BadScene> {};

TEST_P(BadMotions, NameLocationFaultAndRemedy) { expectItsMessage(GetParam()); }

INSTANTIATE_TEST_SUITE_P(LoadScene, BadMotions, testing::ValuesIn(kBadScenes), [](const auto& scene) { return std::string(scene.param.name); });

}  // namespace
