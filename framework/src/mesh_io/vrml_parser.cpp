#include "mesh_io/vrml_parser.h"

#include <algorithm>

namespace kolize::mesh_io::vrml {

namespace {

struct NodeType {
    std::string_view name;
    NodeFactory make;
};

// Billboards do not turn and anchors lead nowhere: what they hold stands as in a group.
constexpr NodeType node_types[] = {
    {"Anchor", new_group},
    {"Billboard", new_group},
    {"Box", new_box},
    {"Collision", new_group},
    {"Cone", new_cone},
    {"Coordinate", new_coordinate},
    {"Cylinder", new_cylinder},
    {"ElevationGrid", new_elevation_grid},
    {"Extrusion", new_extrusion},
    {"Group", new_group},
    {"IndexedFaceSet", new_indexed_face_set},
    {"LOD", new_lod},
    {"Shape", new_shape},
    {"Sphere", new_sphere},
    {"Switch", new_switch},
    {"Transform", new_transform},
    {"WorldInfo", new_world_info},
};

NodeFactory factory_of(std::string_view type) {
    const auto* const found = std::find_if(std::begin(node_types), std::end(node_types),
                                           [type](const NodeType& candidate) { return candidate.name == type; });
    return found == std::end(node_types) ? nullptr : found->make;
}

std::string description(Kind kind) {
    if (kind == Kind::geometry) return "a geometry such as Box";
    return kind == Kind::coordinate ? "a Coordinate" : "a node such as Shape or Transform";
}

}  // namespace

Children Parser::read_file() {
    Children roots;
    while (values.peek().kind != TokenKind::end) read_child(roots);
    return roots;
}

void Parser::read_children(Children& children) {
    values.list([&] { read_child(children); });
}

// The standard wants statements between nodes at the top of the file only; many files have them among children.
void Parser::read_child(Children& children) {
    if (values.skip_statement()) return;
    if (const Node* child = read_node(Kind::child)) children.push_back(child);
}

const Node* Parser::read_node(Kind wanted) {
    const Token first = values.take_word("a node");
    if (first.is("NULL")) return nullptr;
    if (first.is("USE")) return read_use(wanted);
    if (!first.is("DEF")) return read_new_node(first, {}, wanted);
    const std::string_view name = values.take_word("the name of a node").text;
    return read_new_node(values.take_word("a node"), name, wanted);
}

const Node* Parser::read_new_node(const Token& type, std::string_view name, Kind wanted) {
    const NodeFactory make = values.is_prototype(type.text) ? nullptr : factory_of(type.text);
    if (!make) return pass_over(type, name);
    Node& node = *nodes_.emplace_back(make());
    node.type = type;
    if (!name.empty()) definitions_[name] = &node;
    values.open_node(type);
    open_.push_back(&node);
    node.read(*this);
    open_.pop_back();
    node.open = false;
    return put(node, type, wanted);
}

const Node* Parser::pass_over(const Token& type, std::string_view name) {
    if (values.is_prototype(type.text))
        values.notes.add("instances of PROTO " + printable(type.text) + " are not used", type.line);
    else
        values.notes.pass_over_node(type.text, type.line);
    if (!name.empty()) definitions_[name] = nullptr;
    values.open_node(type);
    values.skip_body();
    return nullptr;
}

const Node* Parser::read_use(Kind wanted) {
    const Token name = values.take_word("the name of a node");
    const auto found = definitions_.find(name.text);
    if (found == definitions_.end() && !values.is_skipped_name(name.text))
        values.fail(name.line, "USE " + printable(name.text) + " names a node that no DEF before it does");
    if (found == definitions_.end() || !found->second) {
        values.notes.add("USE " + printable(name.text) + " names a node that is not used", name.line);
        return nullptr;
    }
    if (found->second->open)
        values.fail(name.line, "USE " + printable(name.text) + " stands inside the node of this name");
    return put(*found->second, name, wanted);
}

// Into the node that is open.
const Node* Parser::put(const Node& node, const Token& where, Kind wanted) {
    if (node.kind != wanted)
        values.fail(where.line, printable(node.type.text) + " stands where " + description(wanted) + " should");
    if (open_.size() + static_cast<std::size_t>(node.height) > max_depth)
        values.fail(where.line, "nodes stand in one another more than " + std::to_string(max_depth) + " deep");
    if (!open_.empty()) open_.back()->height = std::max(open_.back()->height, node.height + 1);
    return &node;
}

}  // namespace kolize::mesh_io::vrml
