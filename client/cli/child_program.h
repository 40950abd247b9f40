#ifndef CLEAVE_CLIENT_CLI_CHILD_PROGRAM_H_
#define CLEAVE_CLIENT_CLI_CHILD_PROGRAM_H_

#include <sys/types.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace cleave {

// A program that runs beside this one, in a process group of its own, so that Ctrl-C reaches only
// us; it ends when we do. Not thread-safe; ends in the thread that started it.
class ChildProgram {
 public:
  // words[0] is the path; `input` is what it reads from standard input. Errors: Internal, with the
  // system's reason.
  static absl::StatusOr<std::unique_ptr<ChildProgram>> Start(const std::vector<std::string>& words,
                                                             absl::string_view input = "");
  ~ChildProgram();  // Stop
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;

  // Does not wait.
  bool Ended();
  // Waits until one of them has ended, at most `milliseconds`.
  static void AwaitAny(const std::vector<const ChildProgram*>& children, int milliseconds);
  // Ends it at once, with nothing more to be had from it.
  void Stop();
  // Waits for its end. What it printed on standard output; Internal where it did not end with 0,
  // with what it printed on standard error.
  absl::StatusOr<std::string> Output();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  using File = std::unique_ptr<std::FILE, Close>;

  ChildProgram() = default;

  std::string name_;
  File output_, errors_;
  // A pipe whose other end the child alone holds: it closes with it.
  int lifeline_ = -1;
  pid_t pid_ = -1;  // -1: has ended
  int wait_status_ = 0;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_CHILD_PROGRAM_H_
