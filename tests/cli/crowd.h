// A scene for the programs: boxes that meet in a room.
#pragma once

#include <string>

namespace kolize::test {

inline const std::string crowd = R"([step]
dt = 0.01
time = 1
[[shape]]
name = "brick"
kind = "box"
half_extents = [0.2, 0.5, 0.9]
[[body]]
shape = "brick"
mass = 1
position = [-1.2, 0, 0]
velocity = [3, 2, 1]
angular_velocity = [1, 2, 3]
[[body]]
shape = "brick"
mass = 1
position = [1.2, 0, 0]
velocity = [-3, 1, 1]
[[room]]
min = [-2, -2, -2]
max = [2, 2, 2]
)";

}  // namespace kolize::test
