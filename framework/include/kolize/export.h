// Visibility of the framework's symbols: everything is hidden unless marked.
#pragma once

#define KOLIZE_API __attribute__((visibility("default")))
