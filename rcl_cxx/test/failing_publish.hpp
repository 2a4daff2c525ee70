#pragma once

/// While an object exists, publishing fails in its thread. rcl_publish() of the program is replaced.
class FailingPublish {
 public:
  FailingPublish();
  ~FailingPublish();
  FailingPublish(const FailingPublish &) = delete;
  FailingPublish & operator=(const FailingPublish &) = delete;
};
