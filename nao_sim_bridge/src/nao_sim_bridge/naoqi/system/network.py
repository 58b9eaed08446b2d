"""The network of a simulated robot: a cable and wireless networks of `config/network.json`. No libqi.

It leads nowhere: what a program does to it changes neither the network of this computer nor the way to the simulator.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from ipaddress import IPv4Address
from typing import Any, Callable, Mapping, Sequence

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.naoqi.binding.arguments import known, one_of
from nao_sim_bridge.naoqi.binding.errors import NaoqiError

ETHERNET, WIFI = TECHNOLOGIES = ("ethernet", "wifi")
"""The first that is connected is the way out."""
IDLE, ASSOCIATION, CONFIGURATION, READY = "idle", "association", "configuration", "ready"
FAILURE, DISCONNECT, OFFLINE = "failure", "disconnect", "offline"
STATE_CHANGED, DEFAULT_CHANGED = "NetworkStateChanged", "NetworkDefaultTechnologyChanged"
SERVICE_STATE, SERVICE_ADDED, SERVICE_REMOVED = (
    f"NetworkService{what}" for what in ("StateChanged", "Added", "Removed")
)
INPUT_REQUIRED, CONNECT_STATUS = "NetworkServiceInputRequired", "NetworkConnectStatus"
EVENTS = (
    *(STATE_CHANGED, DEFAULT_CHANGED, SERVICE_STATE, SERVICE_ADDED, SERVICE_REMOVED, INPUT_REQUIRED, CONNECT_STATUS),
    *("NetworkTechnologyAdded", "NetworkTechnologyRemoved"),
)
PSK, ENTERPRISE = "psk", "ieee8021x"
INVALID_KEY = "invalid-key"
DHCP, MANUAL, DIRECT, AUTO = "dhcp", "manual", "direct", "auto"
NAME_LENGTH, PASSPHRASE_LENGTH = (1, 32), (8, 63)
"""Characters of a network of the robot's own."""


@dataclass
class Service:
    """A network that can be connected to.

    The first fields are those of the file. `plugged` is a cable, which is there and connected from the start.
    """

    service_id: str
    name: str
    type: str
    address: str
    gateway: str
    security: Sequence[str] = ()
    passphrase: str = ""
    identity: str = ""
    strength: int = 0
    plugged: bool = False
    state: str = IDLE
    favorite: bool = False
    autoconnect: bool = False
    error: str = ""
    given: str = ""  # the passphrase that somebody has given
    ipv4: dict[str, str] = field(default_factory=lambda: {"Method": DHCP})
    domains: list[str] = field(default_factory=list)
    nameservers: list[str] = field(default_factory=list)
    proxy: dict[str, str] = field(default_factory=dict)

    @property
    def connected(self) -> bool:
        return self.state == READY

    def info(self, netmask: str) -> list[list[Any]]:
        """A NetworkInfo: [[key, value], ...]; empty values are left out."""
        ipv4 = dict(self.ipv4)
        if self.connected and ipv4["Method"] == DHCP:
            ipv4.update(Address=self.address, Netmask=netmask, Gateway=self.gateway)
        names = self.nameservers or ([self.gateway] if self.connected else [])
        rows = {
            "ServiceId": self.service_id,
            "Name": self.name,
            "Type": self.type,
            "State": self.state,
            "Favorite": self.favorite,
            "Autoconnect": self.autoconnect,
            "Security": list(self.security),
            "Domains": list(self.domains),
            "Nameserver": names,
            "IPv4": _pairs(ipv4),
            "Proxy": _pairs(self.proxy),
            "Strength": self.strength,
            "Error": self.error,
        }
        return [[key, value] for key, value in rows.items() if value not in ("", [], 0) or value is False]


class Network:
    """Networks in reach, and which the robot is connected to.

    Args:
        described: Content of `network.json`.
        tell: Called with an event and its value at each change.
    """

    def __init__(self, described: Mapping[str, Any], tell: Callable[[str, Any], None]) -> None:
        self._tell = tell
        self._netmask = described["netmask"]
        self._all = {entry["service_id"]: Service(**entry) for entry in described["services"]}
        self._visible: dict[str, Service] = {}
        self._asked = ""  # the service that waits for a passphrase
        self._provisions: dict[str, dict[str, str]] = {}
        self.tethering = False
        self.tethering_name = self.tethering_passphrase = ""
        for service in self._all.values():
            if service.plugged:
                self._visible[service.service_id] = service
                service.state, service.favorite, service.autoconnect = READY, True, True

    @property
    def state(self) -> str:
        """With a connection "ready", never "online", as none leads to the Internet."""
        return READY if any(service.connected for service in self._all.values()) else OFFLINE

    @property
    def default(self) -> str:
        """The technology that is the way out; empty without one."""
        connected = {service.type for service in self._all.values() if service.connected}
        return next((technology for technology in TECHNOLOGIES if technology in connected), "")

    def scan(self, technology: str | None) -> None:
        """Look which networks of a technology, or of all, are in reach."""
        if technology is not None:
            one_of(technology, "technology", TECHNOLOGIES)
        for service in self._all.values():
            hidden = service.type == WIFI and self.tethering
            if technology in (None, service.type) and not hidden and service.service_id not in self._visible:
                self._visible[service.service_id] = service
                self._tell(SERVICE_ADDED, service.service_id)

    def infos(self) -> list[list[list[Any]]]:
        return [service.info(self._netmask) for service in self._visible.values()]

    def info(self, service_id: str) -> list[list[Any]]:
        return self.service(service_id).info(self._netmask)

    def service(self, service_id: str) -> Service:
        """An UnknownName when there is none in reach, which may need a scan."""
        return self._visible[known(service_id, "service (scan() looks for those in reach)", self._visible)]

    # --- connections -------------------------------------------------------------------------------------------------

    def connect(self, service_id: str) -> None:
        """Connect; an event asks for the passphrase where one is needed, and another says how it ended.

        Raises:
            UnknownName: There is no such network in reach.
            NaoqiError: It is connected already.
        """
        service = self.service(service_id)
        if service.connected:
            raise NaoqiError(f"{service.name} is connected already")
        if PSK in service.security and not service.given:
            self._asked = service_id
            details = [["Type", PSK], ["Requirement", "Mandatory"]]
            self._tell(INPUT_REQUIRED, [["ServiceId", service_id], ["Passphrase", details]])
            return
        self._associate(service)

    def give_input(self, answer: Mapping[str, Any]) -> None:
        """The passphrase that a connection has asked for; a NaoqiError when none has."""
        service_id, passphrase = answer.get("ServiceId"), answer.get("Passphrase")
        if not isinstance(service_id, str) or not isinstance(passphrase, str) or not passphrase:
            raise BadValue("input", dict(answer), '[["ServiceId", id], ["Passphrase", text]]')
        service = self.service(service_id)
        if self._asked != service_id:
            raise NaoqiError(f"{service.name} waits for no input: connect asks for it")
        self._asked, service.given = "", passphrase
        self._associate(service)

    def disconnect(self, service_id: str) -> None:
        """A NaoqiError when it is not connected."""
        service = self.service(service_id)
        if not service.connected:
            raise NaoqiError(f"{service.name} is not connected: its state is {service.state}")
        with_former = self.state, self.default
        self._leave(service)
        self._tell_changes(*with_former)

    def forget(self, service_id: str) -> None:
        """Forget its passphrase, and connect to it by itself no more."""
        service = self.service(service_id)
        if service.connected and not service.plugged:
            self.disconnect(service_id)
        service.favorite, service.autoconnect, service.given = False, False, ""

    def _associate(self, service: Service) -> None:
        former = self.state, self.default
        if service.type == WIFI:
            for other in self._all.values():
                if other.type == WIFI and other.connected:
                    self._leave(other)
            self._set(service, ASSOCIATION)
        if not self._has_key(service):
            service.error, service.given = INVALID_KEY, ""
            self._set(service, FAILURE)
            self._tell_changes(*former)
            self._tell(CONNECT_STATUS, [service.service_id, False, INVALID_KEY, INVALID_KEY])
            return
        service.error = ""
        self._set(service, CONFIGURATION)
        service.favorite = service.autoconnect = True
        self._set(service, READY)
        self._tell_changes(*former)
        self._tell(CONNECT_STATUS, [service.service_id, True])

    def _has_key(self, service: Service) -> bool:
        if PSK in service.security:
            return service.given == service.passphrase
        if ENTERPRISE in service.security:
            given = self._provisions.get(service.name, {})
            return (given.get("Identity"), given.get("Passphrase")) == (service.identity, service.passphrase)
        return True

    def _leave(self, service: Service) -> None:
        self._set(service, DISCONNECT)
        self._set(service, IDLE)

    def _set(self, service: Service, state: str) -> None:
        service.state = state
        self._tell(SERVICE_STATE, [service.service_id, state])

    def _tell_changes(self, state: str, default: str) -> None:
        if self.state != state:
            self._tell(STATE_CHANGED, self.state)
        if self.default != default and self.default:
            self._tell(DEFAULT_CHANGED, self.default)

    # --- settings ----------------------------------------------------------------------------------------------------

    def set_ipv4(self, service_id: str, given: Mapping[str, str]) -> None:
        """{"Method": "dhcp"}, or {"Method": "manual", "Address": ..., "Netmask": ..., "Gateway": ...}."""
        service = self.service(service_id)
        method = one_of(given.get("Method"), "Method", (DHCP, MANUAL))
        if method == DHCP:
            service.ipv4 = {"Method": DHCP}
            return
        for key in ("Address", "Netmask"):
            _address(key, given.get(key, ""))
        if given.get("Gateway"):
            _address("Gateway", given["Gateway"])
        service.ipv4 = {key: given[key] for key in ("Method", "Address", "Netmask", "Gateway") if given.get(key)}

    def set_domains(self, service_id: str, domains: Sequence[str]) -> None:
        self.service(service_id).domains = _few("domains", domains)

    def set_nameservers(self, service_id: str, servers: Sequence[str]) -> None:
        service = self.service(service_id)
        for server in servers:
            _address("nameservers", server)
        service.nameservers = _few("nameservers", servers)

    def set_proxy(self, service_id: str, given: Mapping[str, str]) -> None:
        """{"Method": "direct"}, "auto" with a "URL" if wanted, or "manual" with a "Server" and perhaps "Excludes"."""
        service = self.service(service_id)
        method = one_of(given.get("Method"), "Method", (DIRECT, AUTO, MANUAL))
        if method == MANUAL and not given.get("Server"):
            raise BadValue("Server", given.get("Server", ""), "the proxy server of the method manual")
        service.proxy = {key: given[key] for key in ("Method", "URL", "Server", "Excludes") if given.get(key)}

    def provision(self, given: Mapping[str, str]) -> None:
        """Who the robot is to a network of a company: "Name", "EAP", "Phase2", "Identity", "Passphrase"."""
        missing = [key for key in ("Name", "EAP", "Identity", "Passphrase") if not given.get(key)]
        if missing:
            raise BadValue("provision", sorted(given), f"also {', '.join(missing)}")
        one_of(given["EAP"], "EAP", ("peap", "ttls"))
        if len(self._provisions) >= len(self._all) and given["Name"] not in self._provisions:
            raise NaoqiError(
                f"{len(self._provisions)} networks are provisioned at most: removeProvisionedService first"
            )
        self._provisions[given["Name"]] = dict(given)

    def provisioned(self) -> list[dict[str, str]]:
        """What was given, without passphrases."""
        return [{k: v for k, v in one.items() if k != "Passphrase"} for one in self._provisions.values()]

    def remove_provision(self, name: str) -> None:
        del self._provisions[known(name, "provisioned network", self._provisions)]

    # --- the robot's own network -------------------------------------------------------------------------------------

    def tether(self, name: str, passphrase: str) -> None:
        """Be a wireless network; as with one radio, none is seen any more."""
        for field_name, text, (least, most) in (
            ("name", name, NAME_LENGTH),
            ("passphrase", passphrase, PASSPHRASE_LENGTH),
        ):
            if not least <= len(text) <= most:
                raise BadValue(field_name, text, f"a text of {least} to {most} characters")
        former = self.state, self.default
        self.tethering_name, self.tethering_passphrase, self.tethering = name, passphrase, True
        for service in [one for one in self._visible.values() if one.type == WIFI]:
            if service.connected:
                self._leave(service)
            del self._visible[service.service_id]
            self._tell(SERVICE_REMOVED, service.service_id)
        self._tell_changes(*former)


def _pairs(values: Mapping[str, str]) -> list[list[str]]:
    return [[key, value] for key, value in values.items()]


def _few(field_name: str, texts: Sequence[str]) -> list[str]:
    if len(texts) > 2:
        raise BadValue(field_name, list(texts), "two at most")
    return list(texts)


def _address(field_name: str, text: str) -> None:
    try:
        IPv4Address(text)
    except ValueError:
        raise BadValue(field_name, text, "an IPv4 address such as 192.0.2.20") from None
