// Coordinate and IndexedFaceSet (6.12, 6.23). Colours, normals and texture coordinates are left out.
#include "mesh_io/polygon.h"
#include "mesh_io/vrml_drawing.h"
#include "mesh_io/vrml_parser.h"

namespace kolize::mesh_io::vrml {

namespace {

class IndexedFaceSet : public Node {
public:
    IndexedFaceSet() : Node(Kind::geometry) {}

    void read(Parser& parser) override;

    void draw(Drawing& drawing, const Placement& placement) const override {
        if (!triangles_.empty()) drawing.add(*this, coordinate_->points, triangles_, lines_, placement);
    }

private:
    struct Face {
        std::size_t begin;  // its first corner
        int line;           // where that stands
    };
    // What the fields say: the points may come after the corners.
    struct Faces {
        std::vector<std::uint32_t> corners;  // of all faces, one behind the other
        std::vector<Face> faces;
        bool open = false;  // the last face goes on
        bool convex = true;
        bool counter_clockwise = true;
    };

    static void read_index(ValueReader& values, Faces& read);
    void cut(ValueReader& values, const Faces& read);
    void cut_face(ValueReader& values, std::span<const std::uint32_t> corners, int line, bool convex);

    const Coordinate* coordinate_ = nullptr;
    std::vector<Triangle> triangles_;
    std::vector<int> lines_;
};

void IndexedFaceSet::read(Parser& parser) {
    ValueReader& values = parser.values;
    Faces read;
    for (std::string_view field; values.next_field(field);) {
        if (field == "coord")
            coordinate_ = parser.read_coordinate();
        else if (field == "coordIndex")
            values.list([&] { read_index(values, read); });
        else if (field == "convex")
            read.convex = values.boolean();
        else if (field == "ccw")
            read.counter_clockwise = values.boolean();
        else
            values.skip_value();
    }
    if (coordinate_) cut(values, read);
}

// The -1 that ends the last face may be missing.
void IndexedFaceSet::read_index(ValueReader& values, Faces& read) {
    const int line = values.peek().line;
    const std::int32_t index = values.integer();
    if (index < -1)
        values.fail(line,
                    "coordIndex must be a point, counted from 0, or -1 behind a face, is " + std::to_string(index));
    if (index >= 0) {
        if (!read.open) read.faces.push_back({read.corners.size(), line});
        read.corners.push_back(static_cast<std::uint32_t>(index));
    }
    read.open = index >= 0;
}

void IndexedFaceSet::cut(ValueReader& values, const Faces& read) {
    const std::span<const std::uint32_t> corners = read.corners;
    for (std::size_t f = 0; f < read.faces.size(); ++f) {
        const auto [begin, line] = read.faces[f];
        const std::size_t end = f + 1 < read.faces.size() ? read.faces[f + 1].begin : corners.size();
        cut_face(values, corners.subspan(begin, end - begin), line, read.convex);
    }
    if (read.counter_clockwise) return;
    for (Triangle& t : triangles_) std::swap(t[1], t[2]);
}

void IndexedFaceSet::cut_face(ValueReader& values, std::span<const std::uint32_t> corners, int line, bool convex) {
    for (const std::uint32_t corner : corners)
        if (corner >= coordinate_->points.size())
            values.fail(line, "a face names point " + std::to_string(corner) + ", but its Coordinate has " +
                                  std::to_string(coordinate_->points.size()) + ", counted from 0");
    if (corners.size() < 3) return values.notes.add("a face of fewer than 3 corners is not used", line);
    if (!convex && corners.size() > max_ear_corners)
        values.fail(line, "a face that may be concave has " + std::to_string(corners.size()) + " corners; " +
                              std::to_string(max_ear_corners) + " are the most");
    if (convex)
        add_fan(triangles_, corners);
    else
        add_ears(triangles_, coordinate_->points, corners);
    lines_.resize(triangles_.size(), line);
}

}  // namespace

void Coordinate::read(Parser& parser) {
    for (std::string_view field; parser.values.next_field(field);) {
        if (field == "point")
            parser.values.list([&] { points.push_back(parser.values.vector3()); });
        else
            parser.values.skip_value();
    }
}

std::unique_ptr<Node> new_coordinate() { return std::make_unique<Coordinate>(); }
std::unique_ptr<Node> new_indexed_face_set() { return std::make_unique<IndexedFaceSet>(); }

}  // namespace kolize::mesh_io::vrml
