// Nodes that hold others: groups, transforms, choices and shapes. And WorldInfo.
#include "mesh_io/vrml_drawing.h"
#include "mesh_io/vrml_parser.h"

namespace kolize::mesh_io::vrml {

namespace {

class Group : public Node {
public:
    Group() : Node(Kind::child) {}

    void read(Parser& parser) override {
        for (std::string_view field; parser.values.next_field(field);) {
            if (field == "children")
                parser.read_children(children_);
            else
                parser.values.skip_value();
        }
    }

    void draw(Drawing& drawing, const Placement& placement) const override {
        for (const Node* child : children_) drawing.draw(*child, placement);
    }

protected:
    Children children_;
};

class TransformNode : public Group {
public:
    void read(Parser& parser) override;

    void draw(Drawing& drawing, const Placement& placement) const override {
        Group::draw(drawing, placement * placement_);
    }

private:
    Placement placement_;
};

// P' = T C R SR S -SR -C P (6.52).
void TransformNode::read(Parser& parser) {
    ValueReader& values = parser.values;
    Vec3 translation = Vec3::Zero(), center = Vec3::Zero(), scale = Vec3::Ones();
    Mat3 rotation = Mat3::Identity(), scale_orientation = Mat3::Identity();
    for (std::string_view field; values.next_field(field);) {
        if (field == "children")
            parser.read_children(children_);
        else if (field == "translation")
            translation = values.vector3();
        else if (field == "rotation")
            rotation = values.rotation();
        else if (field == "scale")
            scale = values.vector3();
        else if (field == "scaleOrientation")
            scale_orientation = values.rotation();
        else if (field == "center")
            center = values.vector3();
        else
            values.skip_value();
    }
    placement_.linear = rotation * scale_orientation * scale.asDiagonal() * scale_orientation.transpose();
    placement_.shift = translation + center - placement_.linear * center;
    // Not the determinant, which may be too small for a double.
    placement_.mirrored = (scale.x() < 0) != ((scale.y() < 0) != (scale.z() < 0));
}

// Draws one of its choices. Where the file chooses none, the first is taken: there would be nothing to compute with.
class Switch : public Group {
public:
    void read(Parser& parser) override {
        for (std::string_view field; parser.values.next_field(field);) {
            if (field == "choice")
                parser.values.list([&] { children_.push_back(parser.read_node(Kind::child)); });
            else if (field == "whichChoice")
                which_ = parser.values.integer();
            else
                parser.values.skip_value();
        }
        if (which_ < 0) parser.values.notes.add("Switch without a choice stands for its first one", type.line);
    }

    void draw(Drawing& drawing, const Placement& placement) const override {
        const auto which = static_cast<std::size_t>(which_ < 0 ? 0 : which_);
        if (which < children_.size() && children_[which]) drawing.draw(*children_[which], placement);
    }

private:
    std::int32_t which_ = -1;
};

// Draws the first level, which is the finest.
class LevelOfDetail : public Group {
public:
    void read(Parser& parser) override {
        for (std::string_view field; parser.values.next_field(field);) {
            if (field == "level")
                parser.read_children(children_);
            else
                parser.values.skip_value();
        }
    }

    void draw(Drawing& drawing, const Placement& placement) const override {
        if (!children_.empty()) drawing.draw(*children_.front(), placement);
    }
};

class Shape : public Node {
public:
    Shape() : Node(Kind::child) {}

    void read(Parser& parser) override {
        for (std::string_view field; parser.values.next_field(field);) {
            if (field == "geometry")
                geometry_ = parser.read_node(Kind::geometry);
            else
                parser.values.skip_value();
        }
    }

    void draw(Drawing& drawing, const Placement& placement) const override {
        if (geometry_) drawing.draw(*geometry_, placement);
    }

private:
    const Node* geometry_ = nullptr;
};

// Its title is left out.
class WorldInfo : public Node {
public:
    WorldInfo() : Node(Kind::child) {}

    void read(Parser& parser) override {
        for (std::string_view field; parser.values.next_field(field);) {
            if (field == "info")
                parser.values.list([&] { parser.info.push_back(parser.values.string()); });
            else
                parser.values.skip_value();
        }
    }
};

}  // namespace

std::unique_ptr<Node> new_group() { return std::make_unique<Group>(); }
std::unique_ptr<Node> new_transform() { return std::make_unique<TransformNode>(); }
std::unique_ptr<Node> new_switch() { return std::make_unique<Switch>(); }
std::unique_ptr<Node> new_lod() { return std::make_unique<LevelOfDetail>(); }
std::unique_ptr<Node> new_shape() { return std::make_unique<Shape>(); }
std::unique_ptr<Node> new_world_info() { return std::make_unique<WorldInfo>(); }

}  // namespace kolize::mesh_io::vrml
