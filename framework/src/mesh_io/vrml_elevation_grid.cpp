// ElevationGrid (6.17): heights over a rectangle of the plane y = 0. An open surface.
#include "mesh_io/vrml_parser.h"

namespace kolize::mesh_io::vrml {

namespace {

class ElevationGrid : public GeneratedGeometry {
public:
    void read(Parser& parser) override;

private:
    Surface surface() const override;
    void require_heights(Parser& parser) const;

    std::int64_t columns_ = 0, rows_ = 0;  // points along x and z
    double x_spacing_ = 1, z_spacing_ = 1;
    std::vector<double> heights_;  // row by row
    bool counter_clockwise_ = true;
};

std::int32_t read_dimension(ValueReader& values) {
    const int line = values.peek().line;
    const std::int32_t dimension = values.integer();
    if (dimension < 0) values.fail(line, "a dimension must not be negative, is " + std::to_string(dimension));
    return dimension;
}

void ElevationGrid::read(Parser& parser) {
    ValueReader& values = parser.values;
    for (std::string_view field; values.next_field(field);) {
        if (field == "xDimension")
            columns_ = read_dimension(values);
        else if (field == "zDimension")
            rows_ = read_dimension(values);
        else if (field == "xSpacing")
            x_spacing_ = values.positive_number();
        else if (field == "zSpacing")
            z_spacing_ = values.positive_number();
        else if (field == "height")
            values.list([&] { heights_.push_back(values.number()); });
        else if (field == "ccw")
            counter_clockwise_ = values.boolean();
        else
            values.skip_value();
    }
    require_heights(parser);
}

void ElevationGrid::require_heights(Parser& parser) const {
    if (columns_ * rows_ != static_cast<std::int64_t>(heights_.size()))
        parser.values.fail(type.line, "ElevationGrid of " + std::to_string(columns_) + " x " + std::to_string(rows_) +
                                          " points has " + std::to_string(heights_.size()) + " heights");
}

Surface ElevationGrid::surface() const {
    Surface grid;
    const auto columns = static_cast<std::uint32_t>(columns_), rows = static_cast<std::uint32_t>(rows_);
    for (std::uint32_t z = 0; z < rows; ++z)
        for (std::uint32_t x = 0; x < columns; ++x)
            grid.points.emplace_back(x * x_spacing_, heights_[z * columns + x], z * z_spacing_);
    for (std::uint32_t z = 0; z + 1 < rows; ++z)
        for (std::uint32_t x = 0; x + 1 < columns; ++x) {
            const std::uint32_t corner = z * columns + x;
            grid.add_quad(corner, corner + columns, corner + columns + 1, corner + 1);  // upward
        }
    if (!counter_clockwise_)
        for (Triangle& t : grid.triangles) std::swap(t[1], t[2]);
    return grid;
}

}  // namespace

std::unique_ptr<Node> new_elevation_grid() { return std::make_unique<ElevationGrid>(); }

}  // namespace kolize::mesh_io::vrml
