// The nodes of a VRML97 file that have a part in its surface.
#pragma once

#include "mesh_io/vrml_lexer.h"

#include <memory>

namespace kolize::mesh_io::vrml {

class Parser;
class Drawing;

// Maps the coordinates of a node to those of the file. `mirrored` if the scales turn the surface inside out.
struct Placement {
    Mat3 linear = Mat3::Identity();
    Vec3 shift = Vec3::Zero();
    bool mirrored = false;

    Vec3 operator*(const Vec3& p) const { return linear * p + shift; }
    Placement operator*(const Placement& inner) const {
        return {linear * inner.linear, linear * inner.shift + shift, mirrored != inner.mirrored};
    }
};

// Where a node may stand: among the children of a group, as the geometry of a Shape, as the points of a face set.
enum class Kind { child, geometry, coordinate };

class Node {
public:
    explicit Node(Kind k) : kind(k) {}
    virtual ~Node() = default;
    Node(const Node&) = delete;
    Node& operator=(const Node&) = delete;

    // Takes the fields and the closing brace.
    virtual void read(Parser& parser) = 0;
    virtual void draw(Drawing&, const Placement&) const {}

    const Kind kind;
    bool open = true;  // being read
    int height = 1;    // 1 more than that of the highest node inside
    Token type;
};

using Children = std::vector<const Node*>;  // owned by the Parser

// The points of IndexedFaceSet.
class Coordinate : public Node {
public:
    Coordinate() : Node(Kind::coordinate) {}
    void read(Parser& parser) override;

    std::vector<Vec3> points;
};

struct Surface {
    std::vector<Vec3> points;
    std::vector<Triangle> triangles;

    // Counter-clockwise; left out where corners coincide.
    void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
    void add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
};

// Geometry whose triangles are made anew wherever it is drawn: a short text may stand for many of them.
class GeneratedGeometry : public Node {
public:
    GeneratedGeometry() : Node(Kind::geometry) {}
    void draw(Drawing& drawing, const Placement& placement) const override;

private:
    virtual Surface surface() const = 0;
};

using NodeFactory = std::unique_ptr<Node> (*)();

std::unique_ptr<Node> new_group();
std::unique_ptr<Node> new_transform();
std::unique_ptr<Node> new_switch();
std::unique_ptr<Node> new_lod();
std::unique_ptr<Node> new_shape();
std::unique_ptr<Node> new_world_info();
std::unique_ptr<Node> new_coordinate();
std::unique_ptr<Node> new_indexed_face_set();
std::unique_ptr<Node> new_box();
std::unique_ptr<Node> new_sphere();
std::unique_ptr<Node> new_cone();
std::unique_ptr<Node> new_cylinder();
std::unique_ptr<Node> new_elevation_grid();
std::unique_ptr<Node> new_extrusion();

}  // namespace kolize::mesh_io::vrml
