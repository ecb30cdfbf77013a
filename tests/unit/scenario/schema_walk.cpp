#include "schema_walk.h"

namespace pyroscene::scenario {

namespace {

class Walk {
public:
    explicit Walk(const config::Node& root) : root_(root) {}

    void visit(const config::Node& node, const std::string& path) {
        SchemaKey key{path, {}, {}, {}, {}, false};
        for (const auto& layer : layers(node)) take_facts(layer, key);
        const config::Node properties = find(node, "properties"), items = find(node, "items");
        const bool list_of_maps = items.present() && find(items, "properties").present();
        key.is_map = properties.present();
        if (key.is_map) key.properties = properties.keys();
        if (!list_of_maps) keys.push_back(key);
        if (list_of_maps) visit(items, path + "[]");
        for (const auto& name : key.properties) visit(properties.child(name), path.empty() ? name : path + "." + name);
        visit_alternatives(node, path);
    }

    std::vector<SchemaKey> keys;

private:
    /// A node and what it refers to.
    [[nodiscard]] std::vector<config::Node> layers(const config::Node& node) const {
        std::vector<config::Node> result{node};
        const std::string reference = node.text("$ref", "");
        if (const auto slash = reference.rfind('/'); slash != std::string::npos)
            result.push_back(root_.child("$defs").child(reference.substr(slash + 1)));
        return result;
    }

    [[nodiscard]] config::Node find(const config::Node& node, const std::string& name) const {
        for (const auto& layer : layers(node))
            if (layer.has(name)) return layer.child(name);
        return {};
    }

    static void take_facts(const config::Node& node, SchemaKey& key) {
        for (const char* fact : {"minimum", "exclusiveMinimum", "maximum", "type"})
            if (node.has(fact)) key.facts.emplace(fact, node.text(fact, ""));
        if (const auto value = node.child("default"); value.is_scalar()) key.facts.emplace("default", value.as_text(""));
        if (const auto value = node.child("default"); value.is_list())
            for (const auto& item : value.items()) key.default_list.push_back(item.as_text(""));
        for (const auto& word : node.child("enum").items()) key.words.push_back(word.as_text(""));
    }

    /// Places are a word or one of two maps: their keys are gathered in one map, as the reader knows them.
    void visit_alternatives(const config::Node& node, const std::string& path) {
        SchemaKey map{path, {}, {}, {}, {}, true};
        for (const auto& alternative : find(node, "oneOf").items()) {
            const config::Node properties = find(alternative, "properties");
            for (const auto& name : properties.keys()) {
                map.properties.push_back(name);
                visit(properties.child(name), path + "." + name);
            }
        }
        if (!map.properties.empty()) keys.push_back(map);
    }

    config::Node root_;
};

}  // namespace

std::vector<SchemaKey> walk_schema(const config::Document& schema) {
    Walk walk(schema.root());
    walk.visit(schema.root(), "");
    return walk.keys;
}

std::string as_yaml(const std::string& path, const std::string& value) {
    const auto dot = path.find('.');
    std::string key = path.substr(0, dot);
    const bool list = key.ends_with("[]");
    if (list) key.resize(key.size() - 2);
    const std::string inner = dot == std::string::npos ? value : "{" + as_yaml(path.substr(dot + 1), value) + "}";
    return key + ": " + (list ? "[" + inner + "]" : inner);
}

}  // namespace pyroscene::scenario
