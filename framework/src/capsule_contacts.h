// Contacts of capsules with everything else. A capsule is all that lies within its radius of a segment, its core.
#pragma once

#include "mesh_contacts.h"
#include "primitive_contacts.h"

namespace kolize {

struct Segment {
    Vec3 from, to;
    Vec3 at(double s) const { return from + s * (to - from); }  // s in [0, 1]
};

// The core of a capsule's shape at a place and turn.
Segment capsule_core(const Shape& shape, const Vec3& position, const Quat& orientation);

// As in primitive_contacts.h: world axes, about the centre of mass of A, the first shape.
void sphere_capsule(double radius_a, const Segment& core_b, double radius_b, Regions& regions);
// normal_b: the half-space's outward normal; offset_b: normal . p is less than that in it.
void capsule_half_space(const Segment& core_a, double radius_a, const Vec3& normal_b, double offset_b,
                        Regions& regions);
// Where the cores are nearest; of cores that run side by side, at both ends of that stretch.
void capsule_capsule(const Segment& core_a, double radius_a, const Segment& core_b, double radius_b, Regions& regions);

// As in mesh_contacts.h: A is the mesh, frame of the mesh. Every place where the distance of the core from the surface
// has a local minimum below the radius; a core that has come inside is led out the nearest way from there.
void mesh_capsule(const Mesh& mesh, const Segment& core, double radius, MeshScratch& scratch, Regions& regions);

}  // namespace kolize
