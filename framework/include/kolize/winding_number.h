// What can be said about the inside of a surface that does not bound one: the generalized winding number, and mass
// properties estimated from it with their uncertainty.
#pragma once

#include <kolize/host.h>
#include <kolize/mass_properties.h>

#include <functional>
#include <memory>

namespace kolize {

// How many times the surface winds around a point: 1 inside and 0 outside of a closed outward surface, in between near
// holes. Jacobson, Kavan, Sorkine-Hornung, "Robust inside-outside segmentation using generalized winding numbers",
// SIGGRAPH 2013; far triangles are summed up by their area vectors: Barill, Dickson, Schmidt, Levin, Jacobson, "Fast
// winding numbers for soups and clouds", SIGGRAPH 2018.
class KOLIZE_API WindingNumber {
public:
    explicit WindingNumber(const TriangleSoup& surface);
    ~WindingNumber();

    // Within 0.01 of the sum of the solid angles of all triangles. May be called from several threads.
    double at(const Vec3& point) const;

private:
    struct Node;
    struct Tree;
    std::unique_ptr<const Tree> tree_;
};

struct MassEstimate {
    MassProperties mass;  // of the points with winding number above one half; all zero if no sample is one
    // Half-widths of the range in which the value may be: from the points whose winding number leaves it open whether
    // they are inside (1/4 to 3/4), and from the number of samples (three standard errors), added. Those of centre and
    // tensor are zero where there is no mass.
    double volume = 0;                      // m^3
    Vec3 center_of_mass = Vec3::Zero();     // m
    Mat3 inertia_over_mass = Mat3::Zero();  // m^2
    std::size_t samples = 0;
};

// Samples the bounding box at a random point in each of about `samples` equal cells; the same points on every call and
// for any number of threads. A surface that faces inward on the whole (the winding numbers have a negative sum) is
// measured as if it were turned over.
// `advance(samples, of)` is called whenever some are done, from any thread.
KOLIZE_API MassEstimate estimate_mass_properties(const TriangleSoup& surface, std::size_t samples, Host& host,
                                                 const std::function<void(std::size_t, std::size_t)>& advance = {});

}  // namespace kolize
