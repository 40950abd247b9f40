#ifndef CLEAVE_SERVER_GATEWAY_RANDOM_ID_H_
#define CLEAVE_SERVER_GATEWAY_RANDOM_ID_H_

#include <string>

namespace cleave {

// 128 bits from the system's randomness, as 32 hex digits: never the same twice.
std::string NewUid();

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_RANDOM_ID_H_
