// Time per call of Pinocchio's algorithms in nanoseconds, as JSON. The robot comes on
// standard input: number of joints; for each joint its rotation, translation, axis, mass,
// centre of mass, inertia and armature; then one state.
#include <algorithm>
#include <chrono>
#include <iostream>
#include <vector>

#include <pinocchio/fwd.hpp>
#include <pinocchio/multibody.hpp>

#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/regressor.hpp>
#include <pinocchio/algorithm/rnea-derivatives.hpp>
#include <pinocchio/algorithm/rnea.hpp>

namespace {

template <int Rows, int Columns>
Eigen::Matrix<double, Rows, Columns> read() {
  Eigen::Matrix<double, Rows, Columns> m;
  for (int i = 0; i < Rows; ++i)
    for (int j = 0; j < Columns; ++j) std::cin >> m(i, j);
  return m;
}

template <typename Call>
double nanoseconds(Call call) {
  constexpr int samples = 60, calls = 20000;
  std::vector<double> times;
  for (int s = 0; s < samples; ++s) {
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < calls; ++i) call();
    const std::chrono::duration<double, std::nano> length =
        std::chrono::steady_clock::now() - begin;
    times.push_back(length.count() / calls);
  }
  std::nth_element(times.begin(), times.begin() + samples / 2, times.end());
  return times[samples / 2];
}

}  // namespace

int main() {
  pinocchio::Model model;
  model.gravity.linear() = Eigen::Vector3d(0.0, 0.0, -9.81);
  int joints = 0;
  std::cin >> joints;
  pinocchio::JointIndex parent = 0;
  Eigen::VectorXd armature(joints);
  for (int i = 0; i < joints; ++i) {
    const Eigen::Matrix3d rotation = read<3, 3>();
    const Eigen::Vector3d translation = read<3, 1>(), axis = read<3, 1>();
    const double mass = read<1, 1>()(0, 0);
    const Eigen::Vector3d com = read<3, 1>();
    const Eigen::Matrix3d about = read<3, 3>();
    armature(i) = read<1, 1>()(0, 0);
    const pinocchio::SE3 place(rotation, translation);
    const std::string name = "j" + std::to_string(i);
    // The joint types with the fastest algorithms in Pinocchio.
    if (axis == Eigen::Vector3d::UnitX())
      parent = model.addJoint(parent, pinocchio::JointModelRX(), place, name);
    else if (axis == Eigen::Vector3d::UnitY())
      parent = model.addJoint(parent, pinocchio::JointModelRY(), place, name);
    else if (axis == Eigen::Vector3d::UnitZ())
      parent = model.addJoint(parent, pinocchio::JointModelRZ(), place, name);
    else
      parent = model.addJoint(parent, pinocchio::JointModelRevoluteUnaligned(axis), place, name);
    model.appendBodyToJoint(parent, pinocchio::Inertia(mass, com, about),
                            pinocchio::SE3::Identity());
  }
  model.armature = armature;
  pinocchio::Data data(model);
  Eigen::VectorXd q(joints), v(joints), a(joints);
  for (auto* values : {&q, &v, &a})
    for (int i = 0; i < joints; ++i) std::cin >> (*values)(i);

  std::cout.precision(6);
  std::cout << "{\"rnea\": " << nanoseconds([&] { pinocchio::rnea(model, data, q, v, a); })
            << ", \"rnea derivatives\": "
            << nanoseconds([&] { pinocchio::computeRNEADerivatives(model, data, q, v, a); })
            << ", \"crba\": " << nanoseconds([&] { pinocchio::crba(model, data, q); })
            << ", \"regressor\": "
            << nanoseconds([&] { pinocchio::computeJointTorqueRegressor(model, data, q, v, a); })
            << "}" << std::endl;
}
