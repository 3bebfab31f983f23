// The same files read by other libraries. Both keep floats, and neither joins vertices here: three a triangle.
#pragma once

#include <kolize/mesh.h>

#include <string>

namespace kolize::real_models {

struct OracleMesh {
    TriangleSoup soup;
    bool curved = false;  // has a sphere, cone or cylinder: how many triangles stand for it is the library's choice
};

// VRML97 by Coin, transforms applied. Coin is known to crash on some bad files. Throws Error if Coin refuses the file.
OracleMesh read_with_coin(const std::string& file);

// OBJ, OFF, PLY and STL by Assimp; points and lines are left out. Throws Error if Assimp refuses the file.
OracleMesh read_with_assimp(const std::string& file);

}  // namespace kolize::real_models
