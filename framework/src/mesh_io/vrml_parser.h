// Builds the nodes of a VRML97 file. What DEF named stands in many places at once, so they form a graph; it has no
// cycles, and no path in it is longer than max_depth.
#pragma once

#include "mesh_io/vrml_node.h"
#include "mesh_io/vrml_values.h"

#include <deque>
#include <unordered_map>

namespace kolize::mesh_io::vrml {

class Parser {
public:
    explicit Parser(const MeshFile& file) : values(file) {}

    // All statements of the file; the nodes live as long as the parser.
    Children read_file();

    // For the nodes. A node statement, which begins with DEF, USE, NULL or the type; nullptr for NULL and for nodes
    // that are passed over.
    const Node* read_node(Kind wanted);
    const Coordinate* read_coordinate() { return static_cast<const Coordinate*>(read_node(Kind::coordinate)); }
    void read_children(Children& children);

    ValueReader values;
    std::vector<std::string> info;

private:
    void read_child(Children& children);
    const Node* read_new_node(const Token& type, std::string_view name, Kind wanted);
    const Node* read_use(Kind wanted);
    const Node* pass_over(const Token& type, std::string_view name);
    const Node* put(const Node& node, const Token& where, Kind wanted);

    std::deque<std::unique_ptr<Node>> nodes_;
    std::vector<Node*> open_;
    std::unordered_map<std::string_view, const Node*> definitions_;  // nullptr: passed over
};

}  // namespace kolize::mesh_io::vrml
