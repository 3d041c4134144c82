#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "callbacks.hpp"
#include "driftmesh/policy.hpp"

namespace driftmesh::python {

/// A policy of placement kLeader from an object of Python with a method plan(load), or a function plan(load), which
/// returns pairs of a subdomain and the rank that should have it. The callbacks must outlive it.
[[nodiscard]] std::shared_ptr<const balancer::Policy> policy_from(const py::object& given, Callbacks& callbacks);

}  // namespace driftmesh::python
