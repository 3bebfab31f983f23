// What the framework lends to a plugin: threads and a log. Plugins own neither.
#pragma once

#include <kolize/export.h>

#include <cstddef>
#include <string_view>
#include <type_traits>

namespace kolize {

class KOLIZE_API Host {
public:
    virtual ~Host() = default;

    // Upper bound of the number of chunks that run at the same time.
    virtual int threads() const = 0;

    // Calls body(chunk, begin, end) for the chunks of [0, count). Chunks have `grain` >= 1 items (the last one may have
    // fewer) whatever the number of threads, so results that are joined in chunk order are the same for any of them.
    // Returns when all are done; the first exception by chunk order is rethrown. Allocates nothing with one thread.
    template <class Body>
    void parallel_for(std::size_t count, std::size_t grain, Body&& body) {
        run_chunks(
            count, grain,
            [](void* context, std::size_t chunk, std::size_t begin, std::size_t end) {
                (*static_cast<std::remove_reference_t<Body>*>(context))(chunk, begin, end);
            },
            const_cast<void*>(static_cast<const void*>(&body)));  // the lambda gives a const Body its const back
    }
    static std::size_t chunk_count(std::size_t count, std::size_t grain) {
        return count / grain + (count % grain != 0);
    }

    // s, from some moment on, for a stage that chooses by measuring. No result may depend on it.
    virtual double now() const = 0;

    // One line for the user's log, at warning level.
    virtual void warn(std::string_view message) = 0;

protected:
    using ChunkFunction = void (*)(void* context, std::size_t chunk, std::size_t begin, std::size_t end);
    virtual void run_chunks(std::size_t count, std::size_t grain, ChunkFunction function, void* context) = 0;
};

}  // namespace kolize
