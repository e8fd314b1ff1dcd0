#pragma once

#include "drench/error.h"
#include "sim/core/check.h"
#include "sim/scene/formula.h"

#include <utility>

namespace drench {

/// Runs what is behind a call of the face, and throws its mistakes in the face's own words. What a program's own motions throw passes.
template <class Body>
decltype(auto) convertErrors(Body&& body)
{
    try {
        return std::forward<Body>(body)();
    } catch (const sim::InputError& error) {
        throw InputError(error.what());
    } catch (const sim::FormulaError& error) {
        throw InputError(error.what());
    } catch (const sim::RunError& error) {
        throw RunError(error.what());
    }
}

}  // namespace drench
