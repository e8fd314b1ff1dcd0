#include "sim/state_hash.h"

#include "sim/state_fields.h"

#include <xxhash.h>

#include <memory>

namespace sim {

namespace {

/// Visits fields (state_fields.h).
class StateHasher {
 public:
    static constexpr bool kFills = false;

    StateHasher() : hash_(XXH3_createState(), XXH3_freeState) { XXH3_64bits_reset(hash_.get()); }
    std::uint64_t hash() const { return XXH3_64bits_digest(hash_.get()); }

    template <class T>
    void number(std::string_view, std::string_view, const T& x)
    {
        add(&x, sizeof x);
    }
    template <class T>
    void list(std::string_view, std::string_view, const std::vector<T>& v)
    {
        const std::size_t size = v.size();
        add(&size, sizeof size);
        add(v.data(), size * sizeof(T));
    }
    template <class Row>
    void rows(std::string_view, std::string_view, std::size_t count, std::size_t size, Row&& row)
    {
        for (std::size_t r = 0; r < count; ++r) add(row(r), size * sizeof(*row(r)));
    }

 private:
    void add(const void* data, std::size_t bytes) { XXH3_64bits_update(hash_.get(), data, bytes); }
    std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> hash_;
};

}  // namespace

std::uint64_t stateHash(const State& state)
{
    StateHasher hasher;
    visitMatter(hasher, state);
    return hasher.hash();
}

}  // namespace sim
