// The head turns to the left, as a client in C++ asks for it: the same actions, from a language of one's own.
//
// Where the driver speaks the older types (messages:=naoqi_bridge; or auto, the default, where that package is
// installed), naoqi_bridge_msgs takes the place of nao_library_actions.
// In a catkin package that depends on roscpp, actionlib and nao_library_actions, linked with ${catkin_LIBRARIES}.
#include <actionlib/client/simple_action_client.h>
#include <nao_library_actions/JointTrajectoryAction.h>
#include <ros/ros.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "turn_head");
  actionlib::SimpleActionClient<nao_library_actions::JointTrajectoryAction> client("joint_trajectory");
  if (!client.waitForServer(ros::Duration(30.0))) {
    ROS_ERROR("no action server joint_trajectory: is the driver running?");
    return 1;
  }
  nao_library_actions::JointTrajectoryGoal goal;
  goal.trajectory.joint_names = {"HeadYaw"};
  goal.trajectory.points.resize(1);
  goal.trajectory.points[0].positions = {0.5};
  goal.trajectory.points[0].time_from_start = ros::Duration(1.0);
  client.sendGoal(goal);
  if (!client.waitForResult(ros::Duration(30.0)) || client.getState() != actionlib::SimpleClientGoalState::SUCCEEDED) {
    ROS_ERROR("the head did not turn: %s", client.getState().getText().c_str());
    return 1;
  }
  ROS_INFO("HeadYaw is %.2f rad", client.getResult()->goal_position.position.at(0));
}
