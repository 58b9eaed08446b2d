"""Users of the robot: who there is, who is here, whom it looks at."""

from __future__ import annotations

import json
import math
from datetime import datetime, timezone

import pytest

from nao_sim_bridge.naoqi.users.book import FORGOTTEN_S, NOBODY, News, UserBook

DATE = datetime(2030, 1, 1, 12, tzinfo=timezone.utc)


@pytest.fixture
def book():
    return UserBook(lambda: DATE)


def test_who_is_followed_is_a_user_whose_session_lasts_as_long_as_the_face_is_seen(book):
    book.track(7, 0.0)
    assert book.news() == [
        (News.CREATED, [1]),
        (News.OPENED, [1]),
        (News.FOCUSED, 1),
        (News.NOBODY_HERE, False),
    ]
    assert (book.user_of_face(7), book.face_of_user(1), book.open) == (1, 7, [1])
    book.see({7: ""}, 1.5)
    book.pass_time(3.0)
    assert book.news() == [] and book.open == [1]
    book.pass_time(4.0)
    assert book.news() == [(News.CLOSED, [1]), (News.FOCUSED, NOBODY), (News.NOBODY_HERE, True)]
    assert book.face_of_user(1) == NOBODY and book.numbers == [1]


def test_a_stranger_is_forgotten_after_ten_minutes_and_a_known_person_is_not(book):
    book.learn(["Ada"], 0.0)
    book.track(7, 0.0)
    book.pass_time(10.0)
    book.news()
    book.pass_time(10.0 + FORGOTTEN_S)
    assert book.numbers == [1, 2]
    book.pass_time(10.1 + FORGOTTEN_S)
    assert book.numbers == book.permanent == [1] and book.news() == [(News.DELETED, [2])]


def test_a_recognised_face_is_that_of_the_person(book):
    book.learn(["Ada"], 0.0)
    book.see({7: "Ada"}, 1.0)
    book.track(7, 1.0)
    assert book.focused == book.of_name("Ada").number == 1 and book.numbers == [1]


def test_a_face_that_is_recognised_later_opens_the_session_of_its_person(book):
    book.learn(["Ada"], 0.0)
    book.track(7, 1.0)
    assert book.open == [2] and book.news()
    book.see({7: "Ada"}, 2.0)
    assert book.news() == [(News.OPENED, [1]), (News.CLOSED, [2]), (News.FOCUSED, 1)]
    assert book.open == [1] and book.user_of_face(7) == 1


def test_whose_face_is_learnt_while_nobody_else_is_here_becomes_permanent(book):
    book.track(7, 0.0)
    book.news()
    book.learn(["Ada"], 1.0)
    assert book.news() == [(News.KNOWN, [1])] and book.permanent == [1]
    book.learn([], 2.0)
    assert book.numbers == [] and book.news() == [
        (News.DELETED, [1]),
        (News.CLOSED, [1]),
        (News.UNKNOWN, [1]),
        (News.FOCUSED, NOBODY),
        (News.NOBODY_HERE, True),
    ]


def test_of_two_people_each_session_lasts_for_itself(book):
    book.track(7, 0.0)
    book.see({7: "", 8: ""}, 0.0)
    book.track(8, 0.5)
    assert (book.open, book.focused) == ([1, 2], 2)
    book.see({8: ""}, 2.5)
    book.pass_time(2.6)
    assert (book.open, book.focused) == ([2], 2)


def test_known_people_come_back_from_a_file(book):
    book.learn(["Ada", "Bob"], 0.0)
    book.track(7, 0.0)
    content = json.loads(json.dumps(book.content()))
    again = UserBook(lambda: DATE)
    again.restore(content)
    assert again.numbers == [1, 2] and again.user(1).created == DATE and again.content() == content
    again.learn(["Ada", "Bob"], 0.0)
    again.track(9, 0.0)
    assert again.focused == 4  # numbers of users who were forgotten are not used again


@pytest.mark.parametrize(
    "users, following",
    [
        ([{"number": "x"}], 1), ([{}], 1), ([5], 1), ([], "y"), ([], True), ([], 10**400), ([], math.inf),
        ([{"number": 1, "name": "Ada", "created": "soon"}], 2),
        ([{"number": 1, "name": "Ada", "created": "2030-01-01T00:00:00"}], 2),
        ([{"number": 1, "name": name, "created": "2030-01-01T00:00:00+00:00"} for name in ("Ada", "Bob")], 2),
    ],
)  # fmt: skip
def test_a_file_with_anything_else_than_users_changes_nothing(book, users, following):
    book.learn(["Ada"], 0.0)
    with pytest.raises((ValueError, TypeError, LookupError)):
        book.restore({"users": users, "next": following})
    assert book.numbers == [1]
