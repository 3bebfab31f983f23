#include "summary.h"

#include <kolize/mass_properties.h>

#include <cstring>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kolize::real_models {

namespace {

constexpr unsigned time_limit = 120;  // s

template <std::size_t size>
void copy_text(char (&to)[size], const std::string& from) {
    std::strncpy(to, from.c_str(), size - 1);
}

std::string words_for(const MeshDefects& defects) {
    if (defects.closed()) return "closed";
    if (defects.open_edges) return std::to_string(defects.open_edges) + " open edges";
    if (!defects.bounds_volume()) return std::to_string(defects.unbalanced_edges) + " unbalanced edges";
    return defects.inverted ? "inverted" : "bounds a volume";
}

Summary summary_of(const OracleMesh& mesh) {
    const TriangleSoup& soup = mesh.soup;
    Summary summary;
    summary.read = true;
    summary.curved = mesh.curved;
    summary.triangles = soup.triangles.size();
    if (soup.triangles.empty()) return summary;
    Aabb bounds;
    for (const Triangle& t : soup.triangles) {
        const Vec3 &a = soup.vertices[t[0]], &b = soup.vertices[t[1]], &c = soup.vertices[t[2]];
        for (const Vec3& corner : {a, b, c}) bounds.include(corner);
        summary.area += 0.5 * (b - a).cross(c - a).norm();
    }
    Eigen::Map<Vec3>(summary.minima) = bounds.min;
    Eigen::Map<Vec3>(summary.maxima) = bounds.max;
    const MeshDefects defects = inspect(join_equal_vertices(soup));
    summary.bounds_volume = defects.bounds_volume();
    if (summary.bounds_volume) summary.volume = mass_properties(soup).volume;
    copy_text(summary.surface, words_for(defects));
    return summary;
}

[[noreturn]] void be_child(Reader reader, const std::string& file, int pipe_end) {
    alarm(time_limit);
    dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);  // Coin warns at length
    Summary summary;
    try {
        summary = summary_of(reader(file));
    } catch (const std::exception& error) {
        copy_text(summary.refusal, error.what());
    }
    _exit(write(pipe_end, &summary, sizeof summary) == sizeof summary ? 0 : 1);
}

Summary not_read(int status) {
    Summary summary;
    copy_text(summary.refusal, WIFSIGNALED(status) ? std::string("ended by: ") + strsignal(WTERMSIG(status))
                                                   : "left with code " + std::to_string(WEXITSTATUS(status)));
    return summary;
}

}  // namespace

Summary summary_by(Reader reader, const std::string& file) {
    int ends[2];
    if (pipe(ends) != 0) throw Error("no pipe to be had");
    const pid_t child = fork();
    if (child < 0) throw Error("no process to be had");
    if (child == 0) be_child(reader, file, ends[1]);
    close(ends[1]);
    Summary summary;
    const bool complete = read(ends[0], &summary, sizeof summary) == sizeof summary;
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    return complete ? summary : not_read(status);
}

}  // namespace kolize::real_models
