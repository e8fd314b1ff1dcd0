#include "tests/sim/scene/bad_scene.h"

// Variants and overrides.

namespace {

const BadScene kBadScenes[] = {
    {"VariantsEmpty", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
compare: {variants: []}
)",
     "bad.yaml:3: compare.variants must list variants, or map keys to lists of values, not an empty list"},
    {"VariantsProductOfEmptyWord", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
compare: {variants: {transfer.method: [pic, ""]}}
)",
     "bad.yaml:3: compare.variants.transfer.method has an empty value"},
    {"VariantsProductOfNames", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
compare: {variants: {name: [pic, apic]}}
)",
     "bad.yaml:3: compare.variants.name is no key of a scene; write one like transfer.method"},
    {"VariantsProductOfWord", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
compare: {variants: {transfer.method: pic}}
)",
     "bad.yaml:3: compare.variants.transfer.method must be a list of values to try, not \"pic\""},
    {"VariantWithoutLabel", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
compare: {variants: [{transfer.method: pic}]}
)",
     "bad.yaml:3: a variant needs a label, like label: APIC"},
    {"VariantNameTwice", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
compare:
  variants:
    - {label: PIC, transfer.method: pic}
    - {label: pic, transfer.method: pic}
)",
     "bad.yaml:6: two variants are named \"pic\"; give one of them another name"},
    {"VariantNamedDefault", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
compare: {variants: [{label: Default, transfer.method: pic}]}
)",
     "bad.yaml:3: a variant cannot be named default: that is the scene without a variant"},
    {"VariantName", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
compare: {variants: [{name: A-B, label: x}]}
)",
     "bad.yaml:3: variant name \"A-B\" may have a-z, 0-9 and _ only; a_b would do"},
    {"VariantUnknown", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
compare:
  variants:
    - {label: PIC, transfer.method: pic}
    - {label: Bad, transfer.method: picc}
    - {label: Typo, tranfer.method: pic}
    - {label: Gone, liquid.sources.column.fill: lattice}
)",
     "bad.yaml: no variant \"nothing\"; there is pic, bad, typo, gone", "nothing"},
    {"VariantOfNone", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml: no variant \"pic\": the scene has none", "pic"},
    {"VariantBadValue", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
compare:
  variants:
    - {label: PIC, transfer.method: pic}
    - {label: Bad, transfer.method: picc}
    - {label: Typo, tranfer.method: pic}
    - {label: Gone, liquid.sources.column.fill: lattice}
)",
     "bad.yaml:6: transfer.method: \"picc\" is unknown (did you mean \"pic\"?)", "bad"},
    {"VariantBadKey", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
compare:
  variants:
    - {label: PIC, transfer.method: pic}
    - {label: Bad, transfer.method: picc}
    - {label: Typo, tranfer.method: pic}
    - {label: Gone, liquid.sources.column.fill: lattice}
)",
     "bad.yaml:7: unknown key \"tranfer\" (did you mean \"transfer\"?)", "typo"},
    {"VariantBadElement", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
compare:
  variants:
    - {label: PIC, transfer.method: pic}
    - {label: Bad, transfer.method: picc}
    - {label: Typo, tranfer.method: pic}
    - {label: Gone, liquid.sources.column.fill: lattice}
)",
     "bad.yaml:8: liquid.sources has no element \"column\"; it has 1, counted from 0", "gone"},
    {"SetWithoutEquals",
     R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "--set time.dt: an override reads key.key=value, like transfer.method=apic",
     "",
     {"time.dt"}},
    {"SetWithoutKey",
     R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "--set =3: an override reads key.key=value, like transfer.method=apic",
     "",
     {"=3"}},
    {"SetWithoutValue",
     R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "--set time.dt=: no value after the = sign",
     "",
     {"time.dt="}},
    {"SetEmptyPart",
     R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "--set time..dt=3: \"time..dt\" is no path of keys; write key.key, like transfer.method",
     "",
     {"time..dt=3"}},
    {"SetBadYaml",
     R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "--set time.dt=[1: not valid YAML: end of sequence flow not found",
     "",
     {"time.dt=[1"}},
    {"SetUnknownKey",
     R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "--set time.dtt=3: unknown key \"dtt\" in time (did you mean \"dt\"?)",
     "",
     {"time.dtt=3"}},
    {"SetBadValue",
     R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "--set time.dt=-3: time.dt: \"-3\" is out of range; must be above 0 s",
     "",
     {"time.dt=-3"}},
    {"SetThroughNumber",
     R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "--set grid.cell.size=3: grid.cell is \"0.1\", it has no key \"size\"",
     "",
     {"grid.cell.size=3"}},
    {"SetElementOutOfRange",
     R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "--set liquid.sources.1.fill=lattice: liquid.sources has no element \"1\"; it has 1, counted from 0",
     "",
     {"liquid.sources.1.fill=lattice"}},
    {"SetElementNamed",
     R"(grid: {cell: 0.1}
liquid: {sources: [{name: column, shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "--set liquid.sources.colum.fill=lattice: liquid.sources has no element \"colum\" (did you mean \"column\"?)",
     "",
     {"liquid.sources.colum.fill=lattice"}},
    {"SetUnits",
     R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "--set units=si: units belongs to a file and cannot be overridden",
     "",
     {"units=si"}},
};

class BadVariants : public testing::TestWithParam<BadScene> {};

TEST_P(BadVariants, NameLocationFaultAndRemedy) { expectItsMessage(GetParam()); }

INSTANTIATE_TEST_SUITE_P(LoadScene, BadVariants, testing::ValuesIn(kBadScenes), [](const auto& scene) { return std::string(scene.param.name); });

}  // namespace
