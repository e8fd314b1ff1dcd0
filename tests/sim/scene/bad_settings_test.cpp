#include "tests/sim/scene/bad_scene.h"

// Syntax and sections.

namespace {

const BadScene kBadScenes[] = {
    {"Empty", "", "bad.yaml: the file is empty; a scene needs at least grid and one source"},
    {"OnlyAComment", "# nothing\n", "bad.yaml: the file is empty; a scene needs at least grid and one source"},
    {"NoMap", R"(- 1
- 2
)",
     "bad.yaml:1: a scene is a map of sections, not a list of 2"},
    {"AWord", "hello\n", "bad.yaml:1: a scene is a map of sections, not \"hello\""},
    {"SecondDocument", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
---
grid: {cell: 0.1}
)",
     "bad.yaml:4: a second document (after ---); one file holds one scene"},
    {"UnclosedBracket", R"(grid: {cell: 0.1
liquid: 1
)",
     "bad.yaml:2: not valid YAML: end of map flow not found"},
    {"Truncated", R"(grid:
  cell: 0.1
liquid:
  sources:
    - shape: {ball: {center: [0, 0,)",
     "bad.yaml:5: not valid YAML: end of sequence flow not found"},
    {"BadIndentation", R"(grid:
  cell: 0.1
 liquid: 1
)",
     "bad.yaml:3: not valid YAML: end of map not found"},
    {"Tab", "grid:\n\tcell: 0.1\n", "bad.yaml:2: a tab in the indentation; YAML wants spaces there"},
    {"ControlByte", "grid: {cell: 0.1}\nscene: {name: \x01}\n", "bad.yaml:2: a byte that is no text (not UTF-8); a scene is a YAML text file"},
    {"DuplicateKey", R"(grid: {cell: 0.1}
time: {dt: 1, duration: 1}
grid: {cell: 0.2}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:3: key \"grid\" is given twice, first in line 1; keep one"},
    {"DuplicateNestedKey", R"(grid: {cell: 0.1}
time:
  dt: 1
  duration: 2
  dt: 3
)",
     "bad.yaml:5: key \"dt\" is given twice, first in line 3; keep one"},
    {"KeyIsList", R"(grid: {cell: 0.1}
? [a, b]
: 1
)",
     "bad.yaml:2: a key must be a word, not a list of 2"},
    {"UndefinedAlias", R"(grid: {cell: 0.1}
gravity: *down
)",
     "bad.yaml:2: not valid YAML: the referenced anchor is not defined"},
    {"AliasInItself", "a: &x [*x]\n", "bad.yaml:1: this alias stands inside its own anchor; write the value out"},
    {"AliasBomb", R"(a: &a [x,x,x,x,x,x,x,x,x,x]
b: &b [*a,*a,*a,*a,*a,*a,*a,*a,*a,*a]
c: &c [*b,*b,*b,*b,*b,*b,*b,*b,*b,*b]
d: &d [*c,*c,*c,*c,*c,*c,*c,*c,*c,*c]
e: &e [*d,*d,*d,*d,*d,*d,*d,*d,*d,*d]
f: &f [*e,*e,*e,*e,*e,*e,*e,*e,*e,*e]
)",
     "bad.yaml:6: more than 500000 values, aliases copied out; a scene has hundreds"},
    {"TooDeep", "a: [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]\n",
     "bad.yaml:1: more than 48 levels of nesting"},
    {"NewerSchema", R"(drench: 2
future: 1
)",
     "bad.yaml:1: this scene wants schema version 2, this program reads version 1; use a newer drench"},
    {"NoSchemaVersion", "drench: one\n", "bad.yaml:1: drench: \"one\" is no schema version; write drench: 1"},
    {"UnknownUnits", R"(units: imperial
grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:1: units: \"imperial\" is unknown; write cgs or si"},
    {"NoGrid", "liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}\n",
     "bad.yaml:1: grid is missing; it is where the size of cells stands, like grid: {cell: 0.288}"},
    {"NoCell", R"(grid: {}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:1: grid.cell is missing; it is the edge of a grid cell, like cell: 0.288"},
    {"NearKey", R"(grid: {cell: 0.1}
time:
  dtt: 0.1
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:3: unknown key \"dtt\" in time (did you mean \"dt\"?)"},
    {"NearKeyInLiquid", R"(grid: {cell: 0.1}
liquid:
  viscocity: 1
)",
     "bad.yaml:3: unknown key \"viscocity\" in liquid (did you mean \"viscosity\"?)"},
    {"FarKey", R"(grid: {cell: 0.1}
solver: {bananas: 1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: unknown key \"bananas\" in solver (there is pressure_tolerance, max_iterations, viscosity_tolerance, wicking_substeps)"},
    {"NearSection", R"(gird: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:1: unknown key \"gird\" (did you mean \"grid\"?)"},
    {"DottedKey", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
time.dt: 0.1
)",
     "bad.yaml:3: unknown key \"time.dt\"; dotted keys stand in variants and behind --set, write them as maps here"},
    {"SectionIsNumber", R"(grid: {cell: 0.1}
time: 5
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: time: needs a map of keys, not \"5\""},
    {"SectionIsEmpty", R"(grid: {cell: 0.1}
time:
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: time: needs a map of keys, not nothing"},
    {"SectionIsList", R"(grid: {cell: 0.1}
solver: [1]
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:2: solver: needs a map of keys, not a list of 1"},
};

class BadSettings : public testing::TestWithParam<BadScene> {};

TEST_P(BadSettings, NameLocationFaultAndRemedy) { expectItsMessage(GetParam()); }

INSTANTIATE_TEST_SUITE_P(LoadScene, BadSettings, testing::ValuesIn(kBadScenes), [](const auto& scene) { return std::string(scene.param.name); });

}  // namespace
