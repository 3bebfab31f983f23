// The counter of the program itself, which holds plugins to the same contract as the tests.
#pragma once

#include "allocations.h"
