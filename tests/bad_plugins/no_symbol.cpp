// A shared library like any other: no plugin, and nothing wrong with it.
extern "C" __attribute__((visibility("default"))) int answer() { return 42; }
