#ifndef CLEAVE_SERVER_SESSION_SESSION_PATHS_H_
#define CLEAVE_SERVER_SESSION_SESSION_PATHS_H_

#include <string>

namespace cleave {

// Where things are in a session directory.
struct SessionPaths {
  std::string root;

  std::string config() const { return root + "/config.pb"; }
  std::string journal() const { return root + "/journal"; }
  std::string frames() const { return root + "/frames"; }
  std::string checkpoints() const { return root + "/checkpoints"; }
  std::string reports() const { return root + "/reports.jsonl"; }
  std::string events() const { return root + "/events"; }
  std::string owner() const { return root + "/owner"; }
  // Logs of coarser rungs and of regions, each encoded from frames(): they can be made again.
  std::string rungs() const { return root + "/rungs"; }
  std::string rung(const std::string& name) const { return rungs() + "/" + name; }
  std::string rung_owner(const std::string& name) const { return rung(name) + ".owner"; }
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_SESSION_SESSION_PATHS_H_
