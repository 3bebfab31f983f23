#include "oracle_readers.h"

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

namespace kolize::real_models {

namespace {

void add_triangle(TriangleSoup& soup, const aiMesh& mesh, const aiFace& face) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (unsigned k = 0; k < 3; ++k) {
        const aiVector3D& p = mesh.mVertices[face.mIndices[k]];
        soup.vertices.emplace_back(p.x, p.y, p.z);
    }
    soup.triangles.push_back({first, first + 1, first + 2});
}

}  // namespace

OracleMesh read_with_assimp(const std::string& file) {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(file, aiProcess_Triangulate);
    if (!scene) throw Error(importer.GetErrorString());
    OracleMesh result;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
        const aiMesh& mesh = *scene->mMeshes[m];
        for (unsigned f = 0; f < mesh.mNumFaces; ++f)
            if (mesh.mFaces[f].mNumIndices == 3) add_triangle(result.soup, mesh, mesh.mFaces[f]);
    }
    return result;
}

}  // namespace kolize::real_models
