"""Services and action servers that scenarios call."""

import rospy

from nao_library_modules.simple_action_client import SimpleActionClient
from nao_sim_bridge.testing import wait_until

LIMIT = 30.0


def service(name, kind, limit=LIMIT):
    """A service, when it is there; s of wall time at most."""
    rospy.wait_for_service(name, limit)
    return rospy.ServiceProxy(name, kind)


def answer(call, *fields):
    """Error text of a service, empty if it did what it was asked."""
    try:
        call(*fields)
    except rospy.ServiceException as error:
        return str(error)
    return ""


def configuration(settings):
    """What a server of dynamic_reconfigure has set now; its client's get_configuration waits for no topic."""
    return settings.update_configuration({})


def action_client(name, action, limit=LIMIT):
    """The client of an action server, when that is there; s of wall time at most."""
    client = SimpleActionClient(name, action)
    wait_until(lambda: client.wait_for_server(rospy.Duration(0.01)), limit, name)
    return client
