"""Services, topics and action servers of the stack, as scenarios use them."""

import rospy

from nao_library_modules.ros.goal_client import SimpleActionClient
from nao_sim_bridge.testing import wait_until

LIMIT = 60.0


def service(name, kind, limit=LIMIT):
    """A service, when it is there; s of wall time at most."""
    rospy.wait_for_service(name, limit)
    return rospy.ServiceProxy(name, kind)


def answer(call, *fields, **named):
    """Error text of a service, empty if it did what it was asked."""
    try:
        call(*fields, **named)
    except rospy.ServiceException as error:
        return str(error)
    return ""


def configuration(settings):
    """What a server of dynamic_reconfigure has set now; its client's get_configuration waits for no topic."""
    return settings.update_configuration({})


def measured_now(topic, kind):
    """A message of a topic that was measured after now."""
    began = rospy.Time.now()
    while True:
        message = rospy.wait_for_message(topic, kind, 60.0)
        if message.header.stamp > began:
            return message


def publisher(test, name, kind, **options):
    """A publisher of a topic that somebody listens to; it ends with the test."""
    made = rospy.Publisher(name, kind, queue_size=10, **options)
    test.addCleanup(made.unregister)
    wait_until(lambda: made.get_num_connections() > 0, 60.0, f"subscriber of {name}")
    return made


def action_client(name, action, limit=LIMIT):
    """The client of an action server, when that is there; s of wall time at most."""
    client = SimpleActionClient(name, action)
    wait_until(lambda: client.wait_for_server(rospy.Duration(0.01)), limit, name)
    return client
