#!/usr/bin/env python3
"""A camera without a robot: `~image_raw` shows a grey that grows brighter, ten times a second, 64 x 48 pixels."""

import rospy
from sensor_msgs.msg import Image

WIDTH, HEIGHT = 64, 48

if __name__ == "__main__":
    rospy.init_node("usb_cam")
    pictures = rospy.Publisher("~image_raw", Image, queue_size=1)
    rate, grey = rospy.Rate(10.0), 0
    while not rospy.is_shutdown():
        grey = (grey + 5) % 250
        picture = Image(width=WIDTH, height=HEIGHT, encoding="mono8", step=WIDTH, data=bytes([grey]) * (WIDTH * HEIGHT))
        picture.header.stamp = rospy.Time.now()
        pictures.publish(picture)
        rate.sleep()
