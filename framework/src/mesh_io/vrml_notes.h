// What a VRML file holds and the reader passes over.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kolize::mesh_io::vrml {

// One sentence for each kind of thing, with the line of the first and the count if there are more.
class Notes {
public:
    // A node of this type: "Inline is not used", "3 Inline nodes are not used", "2 sensors are not used". Nothing is
    // said of lights, viewpoints and the like, which have no part in the surface.
    void pass_over_node(std::string_view type, int line);
    // PROTO, EXTERNPROTO or ROUTE.
    void pass_over_statement(std::string_view keyword, int line);
    // Any other sentence.
    void add(const std::string& sentence, int line);

    // "file:line: sentence", by line.
    std::vector<std::string> sentences(const std::string& file) const;

private:
    struct Kind {
        std::string one;   // the sentence for one
        std::string many;  // what follows the count; empty if the sentence serves for any number
        int line = 0;
        std::size_t count = 0;
    };

    void count(const std::string& key, const Kind& kind);

    std::map<std::string, Kind> kinds_;
};

}  // namespace kolize::mesh_io::vrml
