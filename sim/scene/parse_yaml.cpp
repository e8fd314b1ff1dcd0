#include "sim/scene/node.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <map>
#include <sstream>

// The only file that sees yaml-cpp: its events become Nodes, and what it lets pass but a scene must not is refused.

namespace sim {

namespace {

constexpr std::size_t kMaxDepth = 48;    // maps and lists inside each other; a scene needs about ten
constexpr const char* kMergeKey = "<<";  // of YAML 1.1: the map has the keys of others, too

/// Builds the tree; bounded in depth and size, so that no file can ask for more memory than its own order of magnitude.
class TreeBuilder : public YAML::EventHandler {
 public:
    explicit TreeBuilder(std::shared_ptr<const TextSource> source) : source_(std::move(source)) {}

    Node root;
    bool isEmpty = true;

    void OnDocumentStart(const YAML::Mark&) override {}
    void OnDocumentEnd() override {}

    void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add(leaf(Node::Kind::Null, mark, ""), anchor); }

    void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, const std::string& value) override
    {
        add(leaf(Node::Kind::Scalar, mark, value), anchor);
    }

    void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override
    {
        const auto found = anchors_.find(anchor);
        if (found == anchors_.end()) fail(locationOf(mark), "this alias stands inside its own anchor; write the value out");
        count_ += found->second.size;
        checkCount(mark);
        Node copy = found->second.node;
        copy.location = locationOf(mark);
        attach(std::move(copy));
    }

    void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, YAML::EmitterStyle::value) override
    {
        open(Node::Kind::List, mark, anchor);
    }
    void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, YAML::EmitterStyle::value) override
    {
        open(Node::Kind::Map, mark, anchor);
    }
    void OnSequenceEnd() override { close(); }
    void OnMapEnd() override { close(); }

 private:
    struct Open {
        Node node;
        YAML::anchor_t anchor;
        std::size_t countBefore;
        std::map<std::string, int> seen;  ///< keys of a map, and their lines
        std::string key;
        SourceLocation keyLocation;
        bool hasKey = false;
        std::vector<Node> merged = {};  ///< maps behind the key <<
    };
    struct Anchored {
        Node node;
        std::size_t size;
    };

    SourceLocation locationOf(const YAML::Mark& mark) const { return {source_, mark.line + 1}; }

    void checkCount(const YAML::Mark& mark) const
    {
        if (const std::size_t most = source_->bounds.values; count_ > most)
            fail(locationOf(mark), fmt::format("more than {} values, aliases copied out; a scene has hundreds", most));
    }

    Node leaf(Node::Kind kind, const YAML::Mark& mark, const std::string& text)
    {
        ++count_;
        checkCount(mark);
        Node n;
        n.kind = kind;
        n.location = locationOf(mark);
        n.text = text;
        return n;
    }

    void add(Node node, YAML::anchor_t anchor)
    {
        if (anchor != 0) anchors_[anchor] = {node, 1};
        attach(std::move(node));
    }

    void open(Node::Kind kind, const YAML::Mark& mark, YAML::anchor_t anchor)
    {
        if (stack_.size() >= kMaxDepth) fail(locationOf(mark), fmt::format("more than {} levels of nesting", kMaxDepth));
        const std::size_t before = count_;
        Node n = leaf(kind, mark, "");
        stack_.push_back({std::move(n), anchor, before, {}, {}, {}, false});
    }

    void close()
    {
        Open done = std::move(stack_.back());
        stack_.pop_back();
        addMerged(done.merged, done.node);
        if (done.anchor != 0) anchors_[done.anchor] = {done.node, count_ - done.countBefore};
        attach(std::move(done.node));
    }

    void attach(Node node)
    {
        if (stack_.empty()) {
            root = std::move(node);
            isEmpty = false;
            return;
        }
        Open& parent = stack_.back();
        if (parent.node.isList()) {
            parent.node.items.push_back(std::move(node));
        } else if (!parent.hasKey) {
            takeKey(parent, std::move(node));
        } else if (parent.key == kMergeKey) {
            node.location = parent.keyLocation;
            parent.merged = mapsToMerge(std::move(node));
            parent.hasKey = false;
        } else {
            node.location = parent.keyLocation;
            parent.node.keys.push_back(std::move(parent.key));
            parent.node.items.push_back(std::move(node));
            parent.hasKey = false;
        }
    }

    /// What stands behind <<: one map, or a list of them.
    static std::vector<Node> mapsToMerge(Node node)
    {
        std::vector<Node> maps;
        if (node.isList()) maps = std::move(node.items);
        else maps.push_back(std::move(node));
        for (const Node& map : maps)
            if (!map.isMap())
                fail(map.location, fmt::format("<< merges maps, like <<: *sheet with a map that has the anchor &sheet, not {}", map.called()));
        return maps;
    }

    /// Gives the map the keys that it has not itself; of what several have, the first counts.
    static void addMerged(const std::vector<Node>& maps, Node& node)
    {
        for (const Node& map : maps)
            for (std::size_t i = 0; i < map.keys.size(); ++i)
                if (!node.find(map.keys[i])) node.at(map.keys[i], map.items[i].location) = map.items[i];
    }

    void takeKey(Open& parent, Node node)
    {
        if (!node.isScalar() || node.text.empty()) fail(node.location, fmt::format("a key must be a word, not {}", node.called()));
        const auto [first, isNew] = parent.seen.emplace(node.text, node.location.line);
        if (!isNew) fail(node.location, fmt::format("key {} is given twice, first in line {}; keep one", inQuotes(node.text), first->second));
        parent.key = std::move(node.text);
        parent.keyLocation = std::move(node.location);
        parent.hasKey = true;
    }

    std::shared_ptr<const TextSource> source_;
    std::vector<Open> stack_;
    std::map<YAML::anchor_t, Anchored> anchors_;
    std::size_t count_ = 0;
};

/// Length of the UTF-8 character beyond ASCII that starts at text[i]; 0 if the bytes there are none.
std::size_t characterLength(std::string_view text, std::size_t i)
{
    const auto byte = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0u; };
    const unsigned first = byte(i);
    const std::size_t length = first >= 0xC2 && first < 0xE0 ? 2 : (first & 0xF0) == 0xE0 ? 3 : first >= 0xF0 && first < 0xF5 ? 4 : 0;
    for (std::size_t k = 1; k < length; ++k) {
        if ((byte(i + k) & 0xC0) != 0x80) return 0;
    }
    return length;
}

/// Refuses bytes that are no text, and tabs where YAML counts spaces.
void checkText(const std::string& text, const std::shared_ptr<const TextSource>& source)
{
    SourceLocation location{source, 1};
    bool inIndentation = true;
    for (std::size_t i = 0; i < text.size();) {
        const auto c = static_cast<unsigned char>(text[i]);
        const std::size_t length = c < 0x80 ? 1 : characterLength(text, i);
        const bool isControl = (c < 0x20 && c != '\n' && c != '\t' && c != '\r') || c == 0x7f;
        if (length == 0 || isControl) fail(location, "a byte that is no text (not UTF-8); a scene is a YAML text file");
        if (c == '\t' && inIndentation) fail(location, "a tab in the indentation; YAML wants spaces there");
        if (c == '\n') {
            ++location.line;
            inIndentation = true;
        } else if (c != ' ') {
            inIndentation = false;
        }
        i += length;
    }
}

}  // namespace

Node parseYaml(const std::string& text, const std::shared_ptr<const TextSource>& source)
{
    checkText(text, source);
    TreeBuilder tree(source);
    try {
        std::istringstream in(text);
        YAML::Parser parser(in);
        parser.HandleNextDocument(tree);
        if (tree.isEmpty) return Node{Node::Kind::Null, {source, 1}, {}, {}, {}};
        TreeBuilder second(source);
        if (parser.HandleNextDocument(second)) fail(second.root.location, "a second document (after ---); one file holds one scene");
    } catch (const YAML::Exception& e) {
        fail(SourceLocation{source, std::max(1, e.mark.line + 1)}, fmt::format("not valid YAML: {}", e.msg));
    }
    return std::move(tree.root);
}

}  // namespace sim
