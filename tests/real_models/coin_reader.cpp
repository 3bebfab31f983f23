#include "oracle_readers.h"

#include <Inventor/SoDB.h>
#include <Inventor/SoInput.h>
#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/VRMLnodes/SoVRMLCone.h>
#include <Inventor/VRMLnodes/SoVRMLCylinder.h>
#include <Inventor/VRMLnodes/SoVRMLGroup.h>
#include <Inventor/VRMLnodes/SoVRMLSphere.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/fields/SoSFBool.h>
#include <Inventor/nodes/SoShape.h>

#include <utility>

namespace kolize::real_models {

namespace {

bool is_curved(const SoNode& node) {
    return node.isOfType(SoVRMLSphere::getClassTypeId()) || node.isOfType(SoVRMLCone::getClassTypeId()) ||
           node.isOfType(SoVRMLCylinder::getClassTypeId());
}

// Coin hands over the corners as they stand in the file: clockwise faces, and mirrored ones, face inward.
bool is_turned_over(SoNode& node, const SbMatrix& to_world) {
    const auto* ccw = static_cast<const SoSFBool*>(node.getField("ccw"));
    const bool clockwise = ccw && !ccw->getValue();
    return clockwise != (to_world.det3() < 0);
}

void add_triangle(void* user, SoCallbackAction* action, const SoPrimitiveVertex* a, const SoPrimitiveVertex* b,
                  const SoPrimitiveVertex* c) {
    auto& mesh = *static_cast<OracleMesh*>(user);
    SoNode& shape = *action->getCurPathTail();
    mesh.curved = mesh.curved || is_curved(shape);
    if (is_turned_over(shape, action->getModelMatrix())) std::swap(b, c);
    const auto first = static_cast<std::uint32_t>(mesh.soup.vertices.size());
    for (const SoPrimitiveVertex* corner : {a, b, c}) {
        SbVec3f p;
        action->getModelMatrix().multVecMatrix(corner->getPoint(), p);
        mesh.soup.vertices.emplace_back(p[0], p[1], p[2]);
    }
    mesh.soup.triangles.push_back({first, first + 1, first + 2});
}

}  // namespace

OracleMesh read_with_coin(const std::string& file) {
    SoDB::init();
    SoInput input;
    if (!input.openFile(file.c_str())) throw Error("the file cannot be opened");
    SoVRMLGroup* root = SoDB::readAllVRML(&input);
    if (!root) throw Error("no scene comes back");
    root->ref();
    OracleMesh result;
    SoCallbackAction action;
    action.addTriangleCallback(SoShape::getClassTypeId(), add_triangle, &result);
    action.apply(root);
    root->unref();
    return result;
}

}  // namespace kolize::real_models
