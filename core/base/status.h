#ifndef CLEAVE_CORE_BASE_STATUS_H_
#define CLEAVE_CORE_BASE_STATUS_H_

#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

#define CLEAVE_CONCAT_INNER(a, b) a##b
#define CLEAVE_CONCAT(a, b) CLEAVE_CONCAT_INNER(a, b)

// Returns from the enclosing function when `expression` is not OK.
#define CLEAVE_RETURN_IF_ERROR(expression)                                                    \
  do {                                                                                        \
    if (absl::Status cleave_status = (expression); !cleave_status.ok()) return cleave_status; \
  } while (false)

// Unwraps an absl::StatusOr into `target`, or returns its status.
#define CLEAVE_ASSIGN_OR_RETURN(target, expression) \
  CLEAVE_ASSIGN_OR_RETURN_IMPL(CLEAVE_CONCAT(cleave_value_, __LINE__), target, expression)
#define CLEAVE_ASSIGN_OR_RETURN_IMPL(holder, target, expression) \
  auto holder = (expression);                                    \
  if (!holder.ok()) return std::move(holder).status();           \
  target = *std::move(holder)

#endif  // CLEAVE_CORE_BASE_STATUS_H_
