// Exact mass properties of a closed triangle mesh of uniform density.
#pragma once

#include <kolize/mesh.h>

namespace kolize {

struct MassProperties {
    double volume = 0;                      // m^3
    Vec3 center_of_mass = Vec3::Zero();     // in the frame of the input, m
    Mat3 inertia_over_mass = Mat3::Zero();  // about the centre of mass, axes of the input, m^2
};

// Sums over tetrahedra from the first vertex of the first triangle, never from the origin of the frame: the error does
// not grow with the distance from it. The sign of the volume tells inward triangles; centre and tensor are the same for
// both. Without volume all is zero. Polyhedral integrals in covariance form: Blow & Binstock, "How to find the
// inertia tensor (or other mass properties) of a 3D solid body represented by a triangle mesh", 2004; Mirtich, J.
// Graphics Tools 1(2), 1996.
KOLIZE_API MassProperties mass_properties(const TriangleSoup& closed_surface);

// Sum of the areas of the triangles, m^2.
KOLIZE_API double surface_area(const TriangleSoup& surface);

struct PrincipalFrame {
    Vec3 moments = Vec3::Ones();   // principal moments over mass, m^2, in the order of the axes
    Quat axes = Quat::Identity();  // principal frame to input axes; identity if the tensor is diagonal already
};

// Cyclic Jacobi iteration (Golub & Van Loan, Matrix Computations, 8.5): residual of a few ulp for any symmetric tensor.
KOLIZE_API PrincipalFrame principal_frame(const Mat3& inertia_over_mass);

}  // namespace kolize
