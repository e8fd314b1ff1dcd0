#include "sim/scene/scene_file.h"

#include "sim/scene/old_keys.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

namespace sim {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t kMaxFileBytes = 16u << 20;
constexpr std::size_t kMaxIncludes = 100;
constexpr int kSchemaVersion = 1;

fs::path canonicalOf(const fs::path& path)
{
    std::error_code error;
    const fs::path canonical = fs::weakly_canonical(path, error);
    return error ? path : canonical;
}

std::string readText(const fs::path& path, const std::string& where)
{
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status)) fail(where, fmt::format("there is no file {}", fileInQuotes(path.string())));
    if (!fs::is_regular_file(status)) fail(where, fmt::format("{} is no file", fileInQuotes(path.string())));
    const std::uintmax_t size = fs::file_size(path, error);
    if (!error && size > kMaxFileBytes) {
        fail(where, fmt::format("{} is larger than {} MB; meshes go to files of their own", fileInQuotes(path.string()), kMaxFileBytes >> 20));
    }
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    if (!in) fail(where, fmt::format("{} cannot be read", fileInQuotes(path.string())));
    return std::move(text).str();
}

/// Follows includes, depth first; `open` are the files being read, outermost first.
class IncludeReader {
 public:
    explicit IncludeReader(const ReadingBounds& bounds) : bounds_(bounds) {}

    Node read(const std::string& text, const fs::path& path)
    {
        texts_.push_back({path.string(), text});
        auto source = std::make_shared<TextSource>();
        source->name = path.string();
        source->bounds = bounds_;
        if (path.has_parent_path()) source->directory = path.parent_path().string();
        Node root = parseYaml(text, source);
        if (root.isNull()) fail(path.string(), "the file is empty; a scene needs at least grid and one source");
        if (!root.isMap()) fail(root.location, fmt::format("a scene is a map of sections, not {}", root.called()));
        checkVersion(root);
        source->isSi = takeUnits(root);
        expandShortForms(root);
        renameOldKeys(root, notes_);

        const Node* include = root.find("include");
        if (!include) return root;
        open_.push_back(canonicalOf(path));
        Node merged = Node::map(root.location);
        if (!include->isList()) {
            mergeOver(merged, readIncluded(*include, path));
        } else {
            for (const Node& file : include->items) mergeOver(merged, readIncluded(file, path));
        }
        open_.pop_back();
        root.erase("include");
        mergeOver(merged, root);
        return merged;
    }

    /// Notes on keys in them that were called otherwise before.
    std::vector<std::string> takeNotes() { return std::move(notes_); }
    /// All that was read, in that order.
    std::vector<SceneText> takeTexts() { return std::move(texts_); }

 private:
    Node readIncluded(const Node& name, const fs::path& from)
    {
        if (!name.isScalar() || name.text.empty())
            fail(name.location, fmt::format("include names files, like [dam_break.yaml], not {}", name.called()));
        const fs::path path = (from.parent_path() / name.text).lexically_normal();
        requireAllowed(path, name.location);
        if (++included_ > kMaxIncludes) fail(name.location, fmt::format("more than {} included files", kMaxIncludes));
        const fs::path canonical = canonicalOf(path);
        for (const fs::path& open : open_) {
            if (open == canonical)
                fail(name.location, fmt::format("include goes round in a circle: {} is being read already", fileInQuotes(path.string())));
        }
        return read(readText(path, name.location.text()), path);
    }

    /// A newer schema may have keys unknown here, so this comes before any complaint about keys.
    static void checkVersion(const Node& root)
    {
        const Node* version = root.find("drench");
        if (!version || version->text == "1") return;
        const bool isNumber = version->isScalar() && !version->text.empty() && version->text.find_first_not_of("0123456789") == std::string::npos &&
                              version->text != "0";
        if (!isNumber) fail(version->location, fmt::format("drench: {} is no schema version; write drench: {}", version->called(), kSchemaVersion));
        fail(version->location,
             fmt::format("this scene wants schema version {}, this program reads version {}; use a newer drench", version->text, kSchemaVersion));
    }

    /// Reads and removes `units`: it holds for the numbers of its own file, wherever they are merged to.
    static bool takeUnits(Node& root)
    {
        const Node* units = root.find("units");
        if (!units) return false;
        if (!units->isScalar() || (units->text != "cgs" && units->text != "si")) {
            fail(units->location, fmt::format("units: {} is unknown; write cgs or si", units->called()));
        }
        const bool isSi = units->text == "si";
        root.erase("units");
        return isSi;
    }

    ReadingBounds bounds_;
    std::vector<fs::path> open_;
    std::size_t included_ = 0;
    std::vector<std::string> notes_;
    std::vector<SceneText> texts_;
};

void applyAll(const std::vector<Override>& changes, Node& root)
{
    for (const Override& change : changes) {
        for (const char* fixed : {"units", "include", "drench"}) {
            if (change.path == fixed) fail(change.value.location, fmt::format("{} belongs to a file and cannot be overridden", fixed));
        }
        apply(change, root);
    }
}

SceneFile finish(Node root, bool isSi, const fs::path& path, const LoadOptions& options)
{
    SceneFile scene;
    scene.file = path.string();
    scene.root = std::move(root);
    scene.variants = readVariants(scene.root);
    scene.variant = options.variant;
    if (!options.variant.empty()) applyAll(findVariant(scene.variants, options.variant, scene.file).overrides, scene.root);
    for (const std::string& text : options.set) applyAll({parseOverride(text, isSi, &scene.notes)}, scene.root);
    return scene;
}

}  // namespace

SceneFile sceneFileFromText(const std::string& text, const fs::path& name, const LoadOptions& options)
{
    IncludeReader reader(options.bounds);
    Node root = reader.read(text, name);
    const bool isSi = root.location.source->isSi;
    SceneFile file = finish(std::move(root), isSi, name, options);
    file.texts = reader.takeTexts();
    std::vector<std::string> ofFiles = reader.takeNotes();
    file.notes.insert(file.notes.begin(), ofFiles.begin(), ofFiles.end());
    return file;
}

SceneFile loadSceneFile(const fs::path& path, const LoadOptions& options) { return sceneFileFromText(readText(path, path.string()), path, options); }

std::vector<std::string> variantNames(const fs::path& path)
{
    std::vector<std::string> names;
    for (const SceneVariant& variant : loadSceneFile(path).variants) names.push_back(variant.name);
    return names;
}

}  // namespace sim
