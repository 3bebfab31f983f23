// Reads mesh files with kolize and with another library, and compares what they found: a line for each file.
//
//   compare_readers FILE...
//
// The other library is Coin for .wrl and Assimp for the rest. Exit code 1 if they differ in a file.
#include "oracle_readers.h"
#include "summary.h"

#include <kolize/mesh_io.h>

#include <cstdio>

using namespace kolize;
using namespace kolize::real_models;

namespace {

// The other libraries keep floats. Area and volume tell what no bounds can: a part turned, left out or inside out.
constexpr double bounds_tolerance = 1e-5;  // of the size
constexpr double area_tolerance = 1e-4;    // of the area
constexpr double volume_tolerance = 1e-4;  // of the volume
constexpr double chord_tolerance = 5e-3;   // of the size: how far a chord of Coin's circles is from the arc

OracleMesh read_with_kolize(const std::string& file) { return {read_mesh(file), false}; }

struct Comparison {
    Summary ours, theirs;
    const char* oracle;

    bool both() const { return ours.read && theirs.read; }

    double bounds_difference() const {
        double largest = 0;
        for (int axis = 0; axis < 3; ++axis) {
            largest = std::max(largest, std::abs(ours.minima[axis] - theirs.minima[axis]));
            largest = std::max(largest, std::abs(ours.maxima[axis] - theirs.maxima[axis]));
        }
        return largest / ours.size();
    }
    // A map's coordinates may be so large, and its extent so small beside them, that floats cannot be nearer.
    double float_resolution() const {
        return std::numeric_limits<float>::epsilon() * ours.largest_coordinate() / ours.size();
    }
    double area_difference() const { return std::abs(theirs.area - ours.area) / ours.area; }
    double volume_difference() const {
        const double difference = std::abs(theirs.volume - ours.volume);
        return ours.bounds_volume && theirs.bounds_volume && difference > 0 ? difference / std::abs(ours.volume) : 0;
    }

    // Empty if the two agree.
    std::string difference() const {
        if (!ours.read && theirs.read && theirs.triangles > 0) return "refused by kolize: " + std::string(ours.refusal);
        if (!both()) return "";
        const double tolerance = theirs.curved ? chord_tolerance : bounds_tolerance;
        if (!(bounds_difference() <= tolerance + float_resolution())) return "bounds";
        if (theirs.curved) return "";
        if (ours.triangles != theirs.triangles) return "number of triangles";
        if (!(area_difference() <= area_tolerance + float_resolution())) return "area";
        if (!(volume_difference() <= volume_tolerance)) return "volume";
        return "";
    }
    std::string remark() const {
        if (const std::string what = difference(); !what.empty()) return "DIFFERENT: " + what;
        if (!ours.read) return "neither finds a triangle";
        if (!theirs.read) return std::string("refused by ") + oracle + ": " + theirs.refusal;
        if (theirs.curved) return "spheres, cones or cylinders: only the bounds are compared";
        return "";
    }
};

Comparison compare(const std::string& file) {
    const bool is_vrml = file.ends_with(".wrl") || file.ends_with(".WRL");
    return {summary_by(read_with_kolize, file), summary_by(is_vrml ? read_with_coin : read_with_assimp, file),
            is_vrml ? "Coin" : "Assimp"};
}

void print(const std::string& file, const Comparison& c) {
    std::printf("%-32.32s %9zu %9zu", file.c_str() + file.rfind('/') + 1, c.ours.triangles, c.theirs.triangles);
    if (c.both())
        std::printf(" %8.1e %8.1e", c.bounds_difference(), c.area_difference());
    else
        std::printf(" %8s %8s", "-", "-");
    if (c.ours.bounds_volume)
        std::printf(" %12.5g", c.ours.volume);
    else
        std::printf(" %12s", "-");
    std::printf("  %-22s %s\n", c.ours.surface, c.remark().c_str());
}

}  // namespace

int main(int count, char** arguments) {
    std::printf("%-32s %9s %9s %8s %8s %12s  %-22s %s\n", "file", "kolize", "other", "bounds", "area", "volume",
                "surface", "remark");
    int different = 0;
    for (int i = 1; i < count; ++i) {
        std::fflush(stdout);  // else a child that exits in its own way prints it again
        const Comparison comparison = compare(arguments[i]);
        print(arguments[i], comparison);
        if (!comparison.difference().empty()) ++different;
    }
    std::printf("%d files, %d different\n", count - 1, different);
    return different > 0 ? 1 : 0;
}
