"""ALConnectionManager: a cable and wireless networks that the simulated robot connects to."""

import pytest
from simulator import PATIENCE

CABLE = "ethernet_020000000001_cable"
LAB = "wifi_020000000002_6c61626f7261746f7279_managed_psk"
GUESTS = "wifi_020000000002_677565737473_managed_none"
INSTITUTE = "wifi_020000000002_696e73746974757465_managed_ieee8021x"


@pytest.fixture
def network(robot):
    return robot.ALConnectionManager


@pytest.fixture
def of(network):
    """A value of the NetworkInfo of a service."""
    return lambda service, key: dict(network.service(service)).get(key)


def test_a_robot_is_connected_by_cable_and_finds_networks_by_a_scan(robot, network, of):
    added = robot.heard("NetworkServiceAdded")
    assert network.state() == "ready" and network.technologies() == ["ethernet", "wifi"]
    assert [dict(info)["ServiceId"] for info in network.services()] == [CABLE]
    assert dict(of(CABLE, "IPv4")) == {
        "Method": "dhcp",
        "Address": "192.0.2.20",
        "Netmask": "255.255.255.0",
        "Gateway": "192.0.2.1",
    }
    network.scan("wifi")
    assert {added.get(timeout=PATIENCE) for _ in range(3)} == {LAB, GUESTS, INSTITUTE}
    assert of(LAB, "Name") == "laboratory" and of(LAB, "Security") == ["psk"] and of(LAB, "Strength") == 80
    assert dict(network.interfaces())["wlan0"] == "02:00:00:00:00:02"


def test_a_passphrase_is_asked_for_and_a_wrong_one_fails(robot, network, of):
    events = ("NetworkServiceInputRequired", "NetworkServiceStateChanged", "NetworkConnectStatus")
    asked, states, ended = map(robot.heard, events)
    network.scan()
    for passphrase, status in (("wrong", [LAB, False, "invalid-key", "invalid-key"]), ("nao_library", [LAB, True])):
        network.connect(LAB)
        details = [["Type", "psk"], ["Requirement", "Mandatory"]]
        assert asked.get(timeout=PATIENCE) == [["ServiceId", LAB], ["Passphrase", details]]
        network.setServiceInput([["ServiceId", LAB], ["Passphrase", passphrase]])
        assert ended.get(timeout=PATIENCE) == status
    told = sorted(states.get(timeout=PATIENCE)[1] for _ in range(5))  # libqi may hand signals over in another order
    assert told == ["association", "association", "configuration", "failure", "ready"]
    assert of(LAB, "State") == "ready" and of(LAB, "Favorite") is True and of(LAB, "Error") is None
    network.disconnect(LAB)
    network.connect(LAB)  # known by now
    assert of(LAB, "State") == "ready" and len(robot.ALMemory.getEventHistory(events[0])) == 2
    network.forget(LAB)
    assert of(LAB, "State") == "idle" and of(LAB, "Favorite") is False


def test_the_state_of_all_and_the_way_out_are_told(robot, network, of):
    states, ways = robot.heard("NetworkStateChanged"), robot.heard("NetworkDefaultTechnologyChanged")
    network.scan()
    network.connect(GUESTS)
    network.disconnect(CABLE)
    assert network.state() == "ready" and ways.get(timeout=PATIENCE) == "wifi"
    network.disconnect(GUESTS)
    assert network.state() == "offline" == states.get(timeout=PATIENCE)
    network.connect(CABLE)
    assert network.state() == "ready" == states.get(timeout=PATIENCE)


def test_a_network_of_a_company_wants_to_know_who_connects(network, of):
    network.scan()
    network.connect(INSTITUTE)
    assert (of(INSTITUTE, "State"), of(INSTITUTE, "Error")) == ("failure", "invalid-key")
    who = {"Name": "institute", "EAP": "peap", "Phase2": "MSCHAPv2", "Identity": "nao"}
    network.provisionService({**who, "Passphrase": "nao_library"})
    assert network.provisionedServices() == [who]
    network.connect(GUESTS)
    network.connect(INSTITUTE)
    assert of(INSTITUTE, "State") == "ready" and of(GUESTS, "State") == "idle"
    network.removeProvisionedService("institute")
    assert network.provisionedServices() == []


def test_addresses_domains_servers_and_proxies_are_set(network, of):
    manual = {"Method": "manual", "Address": "192.0.2.77", "Netmask": "255.255.255.0"}
    network.setServiceIPv4(CABLE, manual)
    network.setServiceDomains(CABLE, ["example.com"])
    network.setServiceNameservers(CABLE, ["192.0.2.53"])
    network.setServiceProxy(CABLE, {"Method": "manual", "Server": "proxy.example.com:911"})
    assert dict(of(CABLE, "IPv4")) == manual and of(CABLE, "Domains") == ["example.com"]
    assert of(CABLE, "Nameserver") == ["192.0.2.53"] and dict(of(CABLE, "Proxy"))["Server"] == "proxy.example.com:911"
    network.setServiceConfiguration([["ServiceId", CABLE], ["IPv4", [["Method", "dhcp"]]], ["Domains", []]])
    assert dict(of(CABLE, "IPv4"))["Address"] == "192.0.2.20" and of(CABLE, "Domains") is None


def test_the_robot_can_be_a_network_itself_and_sees_no_other_then(robot, network):
    removed = robot.heard("NetworkServiceRemoved")
    network.scan()
    network.enableTethering("wifi", "nao", "secret123")
    assert sorted(removed.get(timeout=PATIENCE) for _ in range(3)) == sorted([LAB, GUESTS, INSTITUTE])
    network.scan()
    assert len(network.services()) == 1 and network.getTetheringEnable("wifi") is True
    assert (network.tetheringName("wifi"), network.tetheringPassphrase("wifi")) == ("nao", "secret123")
    network.disableTethering("wifi")
    network.scan()
    assert len(network.services()) == 4
    network.setCountry("DE")
    assert network.country() == "DE" and len(network.countries()) == 249


def test_what_is_not_there_is_refused_with_the_reason(network, refuses):
    network.scan()
    refuses("ALConnectionManager", f"""
        connect('wifi_home') -> unknown service .scan.. looks for those in reach. 'wifi_home'
        connect('{CABLE}') -> Wired is connected already
        disconnect('{GUESTS}') -> guests is not connected: its state is idle
        setServiceInput([['ServiceId', '{LAB}'], ['Passphrase', 'x']]) -> laboratory waits for no input
        setServiceInput('x') -> input is 'x', allowed is
        scan('bluetooth') -> technology is 'bluetooth', allowed is one of ethernet, wifi
        enableTethering('bluetooth', 'nao', 'secret123') -> technology is 'bluetooth', allowed is wifi
        enableTethering('wifi') -> no name and passphrase yet
        enableTethering('wifi', 'nao', 'short') -> passphrase is 'short', allowed is a text of 8 to 63 characters
        disableTethering('wifi') -> the robot is no network
        setServiceIPv4('{CABLE}', {{'Method': 'manual', 'Address': '1.2.3'}}) -> Address is '1.2.3', allowed is an IPv4
        setServiceProxy('{CABLE}', {{'Method': 'manual'}}) -> the proxy server of the method manual
        setServiceNameservers('{CABLE}', ['192.0.2.1'] * 3) -> allowed is two at most
        provisionService({{'Name': 'institute'}}) -> allowed is also EAP, Identity, Passphrase
        setCountry('XX') -> unknown country 'XX'
    """)  # fmt: skip
