#pragma once

/// While one exists, everything that its thread publishes fails: the program's rcl_publish() is replaced.
class FailingPublish {
 public:
  FailingPublish();
  ~FailingPublish();
  FailingPublish(const FailingPublish &) = delete;
  FailingPublish & operator=(const FailingPublish &) = delete;
};
