"""The radio: bumble's link in memory, with what it lacks for tests of a program: range, signal strength, scan data.

Written for bumble 0.0.236. What its own link and controller do differently from air is named at each method.
"""

from __future__ import annotations

import asyncio

from bumble import hci, ll
from bumble.controller import Controller
from bumble.core import PhysicalTransport
from bumble.link import LocalLink

DEFAULT_RSSI = -50
SUPERVISION_S = 0.5
"""A silent link is given up after this time; the card asks for little more."""
CANCEL_S = 0.005
LEGACY_FEATURES = ~(hci.LeFeatureMask.LL_PRIVACY | hci.LeFeatureMask.LE_EXTENDED_ADVERTISING)
"""Boards of this kind advertise in the old way only; reports are then short and complete."""


class AirLink(LocalLink):
    """All controllers in one room; some of them may be out of each other's reach."""

    def __init__(self) -> None:
        super().__init__()  # type: ignore[no-untyped-call]
        self.out_of_range: set[Controller] = set()
        self.rssi: dict[Controller, int] = {}  # dBm, as heard by everybody else

    def send_advertising_pdu(self, sender_controller: Controller, packet: ll.AdvertisingPdu) -> None:
        """Reach everybody in range, who then knows whom it heard (the stock link does not say)."""
        for controller in list(self.controllers):
            if controller is not sender_controller and self._reach(sender_controller, controller):
                asyncio.get_running_loop().call_soon(_hear, sender_controller, controller, packet)

    def send_acl_data(
        self,
        sender_controller: Controller,
        destination_address: hci.Address,
        transport: PhysicalTransport,
        data: bytes,
    ) -> None:
        """Deliver data under the address its connection was made with (the stock link takes the newest one)."""
        receiver = self.find_le_controller(destination_address)
        if receiver is None or not self._reach(sender_controller, receiver):
            return
        connection = sender_controller.le_connections.get(destination_address)
        source = connection.self_address if connection else sender_controller.random_address
        asyncio.get_running_loop().call_soon(receiver.on_link_acl_data, source, transport, data)

    def send_ll_control_pdu(
        self, sender_address: hci.Address, receiver_address: hci.Address, packet: ll.ControlPdu
    ) -> None:
        """Deliver control data if both ends are in range; silence otherwise."""
        sender, receiver = self.find_le_controller(sender_address), self.find_le_controller(receiver_address)
        if sender and receiver and self._reach(sender, receiver):
            super().send_ll_control_pdu(sender_address, receiver_address, packet)

    def leave_range(self, controller: Controller, after_s: float = SUPERVISION_S) -> None:
        """Silence; after the supervision time both ends learn that the link is lost (reason 0x08)."""
        self.out_of_range.add(controller)
        asyncio.get_running_loop().call_later(after_s, self._supervise, controller)

    def enter_range(self, controller: Controller) -> None:
        """Be heard again."""
        self.out_of_range.discard(controller)

    def _reach(self, one: Controller, other: Controller) -> bool:
        return not {one, other} & self.out_of_range

    def _supervise(self, controller: Controller) -> None:
        if controller not in self.out_of_range:
            return
        for near in list(self.controllers):
            for connection in list(near.le_connections.values()):
                if controller in (near, self.find_le_controller(connection.peer_address)):
                    near.on_le_disconnected(connection, hci.HCI_ErrorCode.CONNECTION_TIMEOUT_ERROR)


class AirController(Controller):
    """A controller whose reports tell the sender's strength and scan response, and which can give up connecting."""

    hearing: Controller | None = None

    def on_hci_le_create_connection_cancel_command(
        self, _command: hci.HCI_LE_Create_Connection_Cancel_Command
    ) -> hci.HCI_StatusReturnParameters:
        """Cancel indeed: the stock controller answers "success" and goes on trying."""
        if self.pending_le_connection is None:
            return hci.HCI_StatusReturnParameters(hci.HCI_ErrorCode.COMMAND_DISALLOWED_ERROR)
        self.pending_le_connection = None
        event = hci.HCI_LE_Connection_Complete_Event(
            status=hci.HCI_ErrorCode.UNKNOWN_CONNECTION_IDENTIFIER_ERROR,
            connection_handle=0,
            role=hci.Role.CENTRAL,
            peer_address_type=0,
            peer_address=hci.Address.ANY,
            connection_interval=0,
            peripheral_latency=0,
            supervision_timeout=0,
            central_clock_accuracy=0,
        )
        asyncio.get_running_loop().call_later(CANCEL_S, self.send_hci_packet, event)
        return hci.HCI_StatusReturnParameters(hci.HCI_ErrorCode.SUCCESS)

    def send_hci_packet(self, packet: hci.HCI_Packet) -> None:
        """Pass a packet to the host; a report of the stock one has a fixed strength and no scan response."""
        if isinstance(packet, hci.HCI_LE_Advertising_Report_Event) and self.hearing is not None:
            packet = self._as_heard(packet, self.hearing)
        super().send_hci_packet(packet)

    def _as_heard(self, packet: hci.HCI_LE_Advertising_Report_Event, sender: Controller) -> hci.HCI_Packet:
        strengths = self.link.rssi if isinstance(self.link, AirLink) else {}
        for report in packet.reports:
            report.rssi = strengths.get(sender, DEFAULT_RSSI)
            if report.event_type == hci.HCI_LE_Advertising_Report_Event.EventType.SCAN_RSP:
                report.data = bytes(sender.le_legacy_advertiser.scan_response_data)
        return hci.HCI_LE_Advertising_Report_Event(packet.reports)


def make_controller(name: str, link: AirLink) -> AirController:
    """A controller in the room; call it inside a running event loop."""
    controller = AirController(name, link=link)
    controller.le_features &= LEGACY_FEATURES
    return controller


def _hear(sender: Controller, receiver: Controller, packet: ll.AdvertisingPdu) -> None:
    if not isinstance(receiver, AirController):
        return
    receiver.hearing = sender
    try:
        receiver.on_ll_advertising_pdu(packet)
    finally:
        receiver.hearing = None
