// Numbers as capsules write them: any count of C99 hex floats in one text, on one line or many. Decimals are taken too.
#pragma once

#include "table_reader.h"

namespace kolize::config {

// Reads one such number; false if the word is none.
bool parse_exact(std::string_view word, double& value);

// All members throw Error with the line of the number that is wrong.
class ExactNumbers {
public:
    explicit ExactNumbers(TableReader& reader) : reader_(reader) {}

    // The key is required; every number has to be finite.
    double number(const std::string& key, const Range& range = {});
    Vec3 vector(const std::string& key, const Range& range = {});
    Quat unit_quaternion(const std::string& key);  // length within 1e-3 of 1, bits as they are
    std::vector<Vec3> vectors(const std::string& key);
    // Each index below `end`.
    std::vector<Triangle> triangles(const std::string& key, std::size_t end);

private:
    std::vector<double> numbers(const std::string& key, const Range& range);
    std::vector<double> numbers(const std::string& key, std::size_t count, const Range& range);

    TableReader& reader_;
};

}  // namespace kolize::config
