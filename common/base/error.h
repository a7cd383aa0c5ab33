#pragma once

#include <stdexcept>

namespace multires {

/// Wrong input or parameters; the message is for the person at the keyboard and names the parameter or the fault.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// @param message  a string or a literal
/// @throws InputError  with the message unless `ok`
template <class Message>
void require(bool ok, const Message& message) {
    if (!ok) throw InputError(message);
}

}  // namespace multires
